#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Step 2 of the prefix sum: one workgroup scans the sums of the blocks in place and stores the total.
#include "scan.glsl"

void main() {
    uint count = block_count();
    uint carry = 0;
    for (uint chunk = 0; chunk < count; chunk += BLOCK) {
        uint first = chunk + gl_LocalInvocationIndex * PER_LANE;
        uint mine[PER_LANE];
        uint sum = 0;
        for (uint i = 0; i < PER_LANE; ++i) {
            mine[i] = first + i < count ? sums[first + i] : 0;
            sum += mine[i];
        }
        uint chunk_sum;
        uint offset = carry + scan_lanes(sum, chunk_sum);
        for (uint i = 0; i < PER_LANE; ++i) {
            if (first + i < count) sums[first + i] = offset;
            offset += mine[i];
        }
        carry += chunk_sum;
    }
    if (gl_LocalInvocationIndex == 0) total[params.total_index] = carry;
}
