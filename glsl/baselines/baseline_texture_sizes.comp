#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Trim textures, first step: the number of words of each texture. One thread for each placed face.
#include "scene.glsl"
#include "baselines/texture.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) readonly buffer Knob { float texels_per_px; uint placed_count; };
layout(scalar, binding = 1) readonly buffer FaceSpeeds { uint face_speeds[]; };
layout(scalar, binding = 2) writeonly buffer Words { uint words[]; };
layout(scalar, binding = 3) buffer CountersBuffer { Counters counters; };

// More words than a storage buffer of any device holds.
const uint TOO_MANY = 0x7fffffffu;

void main() {
    uint placed = thread_number();
    if (placed >= placed_count) return;
    vec2 speed = texture_speed(face_speeds[2u * placed], face_speeds[2u * placed + 1u]);
    TextureSize size = texture_size(speed, texels_per_px);
    bool cut = any(greaterThan(speed * texels_per_px, vec2(TEXTURE_MOST_COLUMNS, TEXTURE_MOST_ROWS)));
    // the sum over all faces must not wrap
    if (cut || float(size.words) * float(size.rows) > float(TOO_MANY / placed_count)) {
        atomicMax(counters.intercepts, TOO_MANY);
        atomicOr(counters.failed, FAILED_INTERCEPTS);
        size.words = 0u;
    }
    words[placed] = size.words * size.rows;
}
