#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `lines`: mu = ceil(height / spacing) scan lines for each v-strip, and a row of each in every bay from the first to
// the last that is seen. One thread a bay, of which the first of a strip has all its rows.
// Twin: src/twin/lines.rs.
#include "bays.glsl"
#include "scene.glsl"

// Strips of some face have several bays.
layout(constant_id = 1) const bool SCENE_HAS_BAYS = false;

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer StripHeights { uint strip_heights[]; };
layout(scalar, binding = 2) writeonly buffer StripCounts { uint strip_counts[]; };
layout(scalar, binding = 3) buffer CountersBuffer { Counters counters; };
layout(scalar, binding = 4) readonly buffer SeenBays { uint seen_bays[]; };

void main() {
    uint strip = gl_GlobalInvocationID.x;
    if (strip >= frame.bay_count) return;
    float lines = ceil(uintBitsToFloat(strip_heights[strip]) / frame.row_px);
    if (lines > float(MAX_ROWS)) atomicAdd(counters.clamps, 1u);
    uint bays = SCENE_HAS_BAYS ? seen_range(seen_bays[strip]).y : 1u;
    strip_counts[strip] = uint(min(lines, float(MAX_ROWS))) * bays;
}
