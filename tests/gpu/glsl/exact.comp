#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// The trim test of exact.glsl, one thread a point, for src/parity/exact.rs.
#define EXACT_BINDING 0
#include "exact.glsl"

layout(local_size_x = 64) in;
struct Answer {
    int winding;
    int next; // of the next point, by this one's list; NOT_FOR it
};
const int NOT_FOR = 99;

layout(scalar, binding = 3) readonly buffer Points { vec2 points[]; };
layout(scalar, binding = 4) writeonly buffer Answers { Answer answers[]; };
layout(push_constant) uniform Push { uint face; uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    vec2 p = points[i];
    vec2 q = points[min(i + 1u, count - 1u)];
    ExactList list = exact_list(face, is_number(p) ? p : vec2(0.0));
    answers[i] = Answer(exact_winding(face, p), holds_for(list, q) ? exact_winding_in(list, q) : NOT_FOR);
}
