// The ring around a point: where a border is looked for.
#ifndef RING_GLSL
#define RING_GLSL

const uint RING_POINTS = 8u;
const float DIAGONAL = 0.70710678;
const vec2 RING[RING_POINTS] = vec2[](vec2(1, 0), vec2(0, 1), vec2(-1, 0), vec2(0, -1), vec2(DIAGONAL, DIAGONAL),
                                      vec2(-DIAGONAL, DIAGONAL), vec2(-DIAGONAL, -DIAGONAL), vec2(DIAGONAL, -DIAGONAL));
// A point of the ring may project a little farther away than its radius: the step was linear.
const float RING_SLACK = 1.25;

#endif
