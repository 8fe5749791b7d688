#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Reach of second-order terms, and places over seams and poles, border_reach.glsl, for src/parity/border_reach.rs.
#include "scene.glsl"
#include "border_reach.glsl"

layout(local_size_x = 64) in;

struct Given {
    vec4 q;
    vec4 end_u;
    vec4 end_v;
    vec4 twist;
    vec2 middle;
    vec2 uv;
    vec2 at;
    uint flags;
};
struct Answer {
    vec3 third;
    float remainder_px;
    vec2 at;
    uint is_in_reach;
    uint is_over_pole;
};

layout(scalar, binding = 0) readonly buffer Givens { Given givens[]; };
layout(scalar, binding = 1) writeonly buffer Answers { Answer answers[]; };
layout(push_constant) uniform Push { uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    Given g = givens[i];
    vec3 third = third_order(g.q, g.end_u, g.end_v, g.twist);
    answers[i] = Answer(
        third, remainder_px(third, g.uv), over_seams(g.flags, g.at),
        uint(is_in_reach(third, g.middle, g.uv)), uint(is_over_pole(g.flags, g.at))
    );
}
