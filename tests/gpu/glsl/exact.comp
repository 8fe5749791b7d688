#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// The trim test of exact.glsl, one thread a point, for src/parity/exact.rs.
#define EXACT_BINDING 0
#include "exact.glsl"

layout(local_size_x = 64) in;
struct Answer {
    int winding;
    uint area; // of the box from this point to the next
};

layout(scalar, binding = 6) readonly buffer Points { vec2 points[]; };
layout(scalar, binding = 7) writeonly buffer Answers { Answer answers[]; };
layout(push_constant) uniform Push { uint face; uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    vec2 p = points[i];
    vec2 q = points[min(i + 1u, count - 1u)];
    vec2 lo = min(p, q);
    vec2 hi = max(p, q);
    answers[i] = Answer(exact_winding(face, p), exact_area(face, lo, hi));
}
