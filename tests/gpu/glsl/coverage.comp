#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// The covered share of pixels, coverage.glsl, one thread a pixel, for src/parity/coverage.rs.
#define EXACT_BINDING 0
#include "exact.glsl"
#include "coverage.glsl"

layout(local_size_x = 64) in;
struct Pixel {
    vec2 uv;
    vec2 along_u;
    vec2 along_v;
};
struct Answer {
    float share;
    vec2 outward;
    uint cut;
};

layout(scalar, binding = 3) readonly buffer Pixels { Pixel pixels[]; };
layout(scalar, binding = 4) writeonly buffer Answers { Answer answers[]; };
layout(push_constant) uniform Push { uint face; uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    Pixel p = pixels[i];
    Cover c = exact_cover(face, p.uv, mat2(p.along_u, p.along_v));
    answers[i] = Answer(c.share, c.outward, c.cut ? 1u : 0u);
}
