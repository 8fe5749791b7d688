#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `blister`: pixels that are not locked are about to ask the Blist again. Says how many layers that makes, and
// whether they were enough.
#include "scene.glsl"
#include "blister.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) buffer CountersBuffer { Counters counters; };
layout(binding = 2, rg32ui) readonly uniform uimage2D layer;

void main() {
    if (imageLoad(layer, ivec2(gl_FragCoord.xy)).x == 0u) return;
    // most pixels find it said already
    if (counters.layers < asked) atomicMax(counters.layers, asked);
    if (asked > frame.layer_capacity) atomicOr(counters.failed, FAILED_LAYERS);
}
