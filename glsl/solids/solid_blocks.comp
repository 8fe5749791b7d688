#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_blocks`: the leaves that each block of tiles may show, in Blist order: counted first, then listed from
// the prefix sum on. One thread for each run of leaves of a block. Twin: src/twin/solid_blocks.rs.
#include "scene.glsl"
#include "tiles.glsl"

layout(constant_id = 6) const bool LISTS = false;

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Rects { Rect rects[]; };
layout(scalar, binding = 2) buffer BlockCounts { uint block_counts[]; };
layout(scalar, binding = 3) readonly buffer BlockStarts { uint block_starts[]; };
layout(scalar, binding = 4) writeonly buffer BlockLeaves { uint block_leaves[]; };

void main() {
    uint n = thread_number();
    uvec2 blocks = block_count(frame);
    uint runs = run_count(frame);
    if (n >= blocks.x * blocks.y * runs) return;
    uint block = n / runs;
    uvec2 first = BLOCK * uvec2(block % blocks.x, block / blocks.x);
    uvec2 last = first + BLOCK - 1u;
    uint start = LISTS ? block_starts[n] : 0u;
    uint count = 0u;
    uint from = n % runs * LEAF_RUN;
    for (uint leaf = from; leaf < min(from + LEAF_RUN, frame.leaf_count); ++leaf) {
        if (!meets(rects[leaf], first, last)) continue;
        if (LISTS && start + count < frame.block_leaf_capacity) block_leaves[start + count] = leaf;
        ++count;
    }
    if (!LISTS) block_counts[n] = count;
}
