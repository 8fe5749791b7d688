#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `bound`: which patches can be seen, and how finely each must be divided.
// One thread an item. Twin: src/twin/bound.rs.
#include "bound.glsl"
#include "factor.glsl"

vec2 factors_of(Patch patch_, uint instance, Seen seen) {
    float pixels = pixels_per_unit(frame, instances[instance], seen);
    return factors(patch_.bend, 8.0 * frame.deviation_px / pixels);
}
