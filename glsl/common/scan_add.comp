#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Step 3 of the prefix sum: adds to every element of a block the sum of the blocks before it.
#include "scan.glsl"

void main() {
    uint count = element_count();
    uint block = workgroup_number();
    uint first = block * BLOCK + gl_LocalInvocationIndex * PER_LANE;
    if (first >= count) return;
    uint before = sums[block];
    for (uint i = first; i < min(first + PER_LANE, count); ++i) offsets[i] += before;
}
