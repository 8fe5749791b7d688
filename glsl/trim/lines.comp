#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `lines`: mu = ceil(height / spacing) scan lines for each v-strip, and a row of each in every bin from the first
// to the last visible one. One thread a bin; the first bin of a strip counts all of its rows. Twin: src/twin/lines.rs.
#include "u_bins.glsl"
#include "scene.glsl"

// Strips of some face have several bins.
layout(constant_id = 1) const bool SCENE_HAS_BINS = false;

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer StripHeights { uint strip_heights[]; };
layout(scalar, binding = 2) writeonly buffer StripCounts { uint strip_counts[]; };
layout(scalar, binding = 3) buffer CountersBuffer { Counters counters; };
layout(scalar, binding = 4) readonly buffer SeenBins { uint seen_bins[]; };

void main() {
    uint strip = thread_number();
    if (strip >= frame.bin_count) return;
    float lines = ceil(uintBitsToFloat(strip_heights[strip]) / frame.row_px);
    if (lines > float(MAX_ROWS)) atomicAdd(counters.clamps, 1u);
    uint bins = SCENE_HAS_BINS ? seen_range(seen_bins[strip]).y : 1u;
    strip_counts[strip] = uint(min(lines, float(MAX_ROWS))) * bins;
}
