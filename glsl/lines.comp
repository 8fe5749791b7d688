#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `lines`: mu = ceil(height / spacing) scan lines for each v-strip. One thread a strip.
// Twin: src/twin/lines.rs.
#include "scene.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer StripHeights { uint strip_heights[]; };
layout(scalar, binding = 2) writeonly buffer LineCounts { uint line_counts[]; };
layout(scalar, binding = 3) buffer CountersBuffer { Counters counters; };

void main() {
    uint strip = gl_GlobalInvocationID.x;
    if (strip >= frame.strip_count) return;
    float lines = ceil(uintBitsToFloat(strip_heights[strip]) / frame.row_px);
    if (lines > float(MAX_ROWS)) atomicAdd(counters.clamps, 1u);
    line_counts[strip] = uint(min(lines, float(MAX_ROWS)));
}
