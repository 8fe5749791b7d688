#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// The look-ups of table.glsl, one thread a point, for src/parity/table.rs: bits 0 to 2 of the point and its line, bit 3 of the
// box around it, bit 4 of the point alone.
#include "scene.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 5) readonly buffer Points { vec2 points[]; };
layout(scalar, binding = 6) writeonly buffer Answers { uint answers[]; };
layout(push_constant) uniform Push { uint first_bin; uint strips; vec2 around; };

#define TABLE_BINDING 1
#include "table.glsl"

void main() {
    uint i = gl_GlobalInvocationID.x;
    vec2 p = points[i];
    answers[i] = table_along(first_bin, strips, p, around.x) |
                 uint(table_same(first_bin, strips, p - around, p + around)) << 3 |
                 uint(table_inside(first_bin, strips, p)) << 4;
}
