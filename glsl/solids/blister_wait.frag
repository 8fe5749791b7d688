#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `blister`: resets the pixels that are not locked, for the next walk of the Blist. Counts the layers, and reports
// whether there were enough.
#include "scene.glsl"
#include "blister.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) buffer CountersBuffer { Counters counters; };
layout(binding = 2, rg32ui) readonly uniform uimage2D layer;

void main() {
    if (imageLoad(layer, ivec2(gl_FragCoord.xy)).x == 0u) return;
    // mostly another pixel has written it already
    if (counters.layers < asked) atomicMax(counters.layers, asked);
    if (asked > frame.layer_capacity) atomicOr(counters.failed, FAILED_LAYERS);
}
