#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `dispatch_arguments`: the rows of each v-strip, as the look-up reads them; for the whole trim table, the numbers of rows and
// segments and the dispatches that follow. One thread a bin; the first of all also does the rest. Twin:
// src/twin/dispatch_arguments.rs.
#include "u_bins.glsl"
#include "scene.glsl"

// Strips of some face have several bins.
layout(constant_id = 1) const bool SCENE_HAS_BINS = false;

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
#include "grid.glsl"
layout(scalar, binding = 1) readonly buffer StripStarts { uint strip_starts[]; };
layout(scalar, binding = 2) readonly buffer SegmentStarts { uint segment_starts[]; };
layout(scalar, binding = 3) writeonly buffer Dispatches { uvec3 dispatches[]; }; // cross, sort, scan of the rows
layout(scalar, binding = 4) writeonly buffer Strips { StripRows strips[]; };
layout(scalar, binding = 5) buffer CountersBuffer { Counters counters; };
layout(scalar, binding = 6) readonly buffer SeenBins { uint seen_bins[]; }; // with SCENE_HAS_BINS

const uint GROUP = 128u;        // threads of a workgroup in passes cross and sort
const uint SCAN_BLOCK = 1024u;  // rows of a workgroup in the prefix sum
const uint MOST_NUMBERED = 0x80000000u; // the threads that fill the last row have 32-bit numbers, too

void main() {
    uint strip = thread_number();
    if (strip >= frame.bin_count) return;
    uint first_row = strip_starts[strip];
    uvec2 seen = SCENE_HAS_BINS ? seen_range(seen_bins[strip]) : uvec2(0u, 1u);
    strips[strip] = StripRows(first_row, (strip_starts[strip + 1u] - first_row) / seen.y, seen.x, seen.y);
    if (strip_starts[strip + 1u] < first_row) {
        // the sum of the rows exceeds 32 bits
        atomicMax(counters.wanted_rows, 0xffffffffu);
        atomicOr(counters.failed, FAILED_ROWS);
    }
    if (strip != 0u) return;
    uint rows = strip_starts[frame.bin_count];
    uint segments = segment_starts[frame.curve_count];
    if (rows > frame.row_capacity) atomicOr(counters.failed, FAILED_ROWS);
    rows = min(rows, frame.row_capacity);
    if (segments > MOST_NUMBERED) {
        counters.clamps += 1u;
        segments = MOST_NUMBERED;
    }
    counters.rows = rows;
    atomicMax(counters.wanted_rows, strip_starts[frame.bin_count]);
    counters.segments = segments;
    dispatches[0] = grid_of((segments + GROUP - 1u) / GROUP);
    dispatches[1] = grid_of((rows + GROUP - 1u) / GROUP);
    dispatches[2] = grid_of((rows + SCAN_BLOCK - 1u) / SCAN_BLOCK);
}
