#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `cull_parts`: finds the placed parts that are hidden behind the surfaces drawn so far. One thread for each part
// in sight. Twin: src/twin/parts.rs.
#include "scene.glsl"
#include "tiles.glsl"
#include "parts.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, push_constant) uniform Push { uint parts_in_sight; } push;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer PartsInSight { PartInSight parts[]; };
layout(scalar, binding = 2) readonly buffer Farthest { float farthest[]; };
layout(scalar, binding = 3) writeonly buffer HiddenNow { uint hidden_now[]; };
#include "nearer.glsl"

uvec2 pixel_of(uint packed) { return uvec2(packed & 0xffffu, packed >> 16); }

void main() {
    uint n = thread_number();
    if (n >= push.parts_in_sight) return;
    PartInSight part = parts[n];
    bool is_hidden = all_pixels_nearer(pixel_of(part.low), pixel_of(part.high), part.depth);
    hidden_now[part.group] = is_hidden ? 1u : 0u;
}
