#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Step 1 of the prefix sum: each workgroup scans its block; its sum goes to sums[block].
#include "scan.glsl"

void main() {
    uint count = element_count();
    uint block = workgroup_number();
    uint first = block * BLOCK + gl_LocalInvocationIndex * PER_LANE;
    uint mine[PER_LANE];
    uint sum = 0;
    for (uint i = 0; i < PER_LANE; ++i) {
        mine[i] = first + i < count ? values[first + i] : 0;
        sum += mine[i];
    }
    uint block_sum;
    uint offset = scan_lanes(sum, block_sum);
    for (uint i = 0; i < PER_LANE; ++i) {
        if (first + i < count) offsets[first + i] = offset;
        offset += mine[i];
    }
    // There may be more workgroups than blocks: the last row is full, or the arguments were written for a longer list.
    if (gl_LocalInvocationIndex == 0 && block < block_count()) sums[block] = block_sum;
}
