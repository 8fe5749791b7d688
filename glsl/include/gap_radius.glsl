// The circle around a point in which borders are looked for.
#ifndef RING_GLSL
#define RING_GLSL

const uint DIRECTION_COUNT = 8u;
const float DIAGONAL = 0.70710678;
const vec2 DIRECTIONS[DIRECTION_COUNT] = vec2[](vec2(1, 0), vec2(0, 1), vec2(-1, 0), vec2(0, -1), vec2(DIAGONAL, DIAGONAL),
                                      vec2(-DIAGONAL, DIAGONAL), vec2(-DIAGONAL, -DIAGONAL), vec2(DIAGONAL, -DIAGONAL));

// Distance from the centre to the sides of the octagon of eight points: a straight border with one of the points beyond
// it is at most this far. A regular hexagon with sides at the same distance has a corner beyond it, too.
const float APOTHEM = 0.92387953; // cos(pi / 8), of the circle's radius
const float CORNER = 1.06680402;  // APOTHEM / cos(pi / 6)

// Faces with exact trims are closer to each other (src/budget.rs), so a square suffices. Its sides are this much
// nearer, and it reaches as far on average.
const float SQUARE = 0.8; // from its middle to its sides, of the circle's radius

// A point of the circle may project a little farther away than its radius, because the step was linear.
const float GAP_SLACK = 1.25;

#endif
