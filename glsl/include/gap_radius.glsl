// The circle around a point: where a border is looked for.
#ifndef RING_GLSL
#define RING_GLSL

const uint DIRECTION_COUNT = 8u;
const float DIAGONAL = 0.70710678;
const vec2 DIRECTIONS[DIRECTION_COUNT] = vec2[](vec2(1, 0), vec2(0, 1), vec2(-1, 0), vec2(0, -1), vec2(DIAGONAL, DIAGONAL),
                                      vec2(-DIAGONAL, DIAGONAL), vec2(-DIAGONAL, -DIAGONAL), vec2(DIAGONAL, -DIAGONAL));

// A straight border that has one of those beyond it is at most as far as the middles of their octagon's sides (APOTHEM). A
// regular hexagon whose sides are as far has a corner beyond it, too.
const float APOTHEM = 0.92387953; // cos(pi / 8), of the circle's radius
const float CORNER = 1.06680402;  // APOTHEM / cos(pi / 6)

// Faces whose trims are exact are nearer to each other (src/budget.rs): a square does, with sides that are nearer by so much
// that it reaches as far on average.
const float SQUARE = 0.8; // from its middle to its sides, of the circle's radius

// A point of the circle may project a little farther away than its radius: the step was linear.
const float GAP_SLACK = 1.25;

#endif
