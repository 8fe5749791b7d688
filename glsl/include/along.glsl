// The result of a trim test for a point and for a stretch of v = const around it: bits.
#ifndef ALONG_GLSL
#define ALONG_GLSL

const uint ALONG_INSIDE = 1u; // the point is inside
const uint ALONG_BEFORE = 2u; // a border crosses the stretch at a smaller u
const uint ALONG_BEHIND = 4u; // a border crosses the stretch at a larger u

#endif
