// What a trim test tells of a point and of the stretch of v = const around it: bits.
#ifndef ALONG_GLSL
#define ALONG_GLSL

const uint ALONG_INSIDE = 1u; // the point is
const uint ALONG_BEFORE = 2u; // a border runs there, at a smaller u
const uint ALONG_BEHIND = 4u; // at a larger u

#endif
