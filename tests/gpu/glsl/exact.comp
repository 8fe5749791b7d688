#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// The trim test of exact.glsl, one thread a point, for src/parity/exact.rs.
#define EXACT_BINDING 0
#include "exact.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 6) readonly buffer Points { vec2 points[]; };
layout(scalar, binding = 7) writeonly buffer Windings { int windings[]; };
layout(push_constant) uniform Push { uint face; uint count; };

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i < count) windings[i] = exact_winding(face, points[i]);
}
