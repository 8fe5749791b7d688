#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_tiles`: the leaves of its block that each tile of the band may show: counted first, then listed. One
// thread a tile.
//
// A step tests four of the block's leaves, since drivers may end long loops. If a driver does, the tile counts as a
// clamp. Twin: src/twin/solid_tiles.rs.
#include "scene.glsl"
#include "tiles.glsl"

layout(constant_id = 6) const bool LISTS = false;

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Rects { Rect rects[]; };
layout(scalar, binding = 2) readonly buffer BlockStarts { uint block_starts[]; };
layout(scalar, binding = 3) readonly buffer BlockLeaves { uint block_leaves[]; };
layout(scalar, binding = 4) buffer TileCounts { uint tile_counts[]; };
layout(scalar, binding = 5) readonly buffer TileStarts { uint tile_starts[]; };
layout(scalar, binding = 6) writeonly buffer TileLeaves { TileLeaf tile_leaves[]; };
layout(scalar, binding = 7) buffer CountersBuffer { Counters counters; };

uvec2 tile;
uint start;
uint count = 0u; // leaves in the tile

void look_at(uint leaf) {
    if (!meets(rects[leaf], tile, tile)) return;
    if (LISTS && start + count < frame.tile_leaf_capacity) tile_leaves[start + count].leaf = leaf;
    ++count;
}

void main() {
    uint n = thread_number();
    uvec2 tiles = band_tiles(frame);
    if (n >= tiles.x * tiles.y) return;
    tile = uvec2(n % tiles.x, frame.band_top / TILE + n / tiles.x);
    uvec2 blocks = block_count(frame);
    uint block = tile.y / BLOCK * blocks.x + tile.x / BLOCK;
    start = LISTS ? tile_starts[n] : 0u;
    uint runs = run_count(frame);
    uint from = block_starts[block * runs];
    uint end = min(block_starts[(block + 1u) * runs], frame.block_leaf_capacity);
    if (n == 0u && !LISTS) {
        uint wanted = block_starts[blocks.x * blocks.y * runs];
        counters.block_leaves = wanted;
        if (wanted > frame.block_leaf_capacity) atomicOr(counters.failed, FAILED_BLOCK_LEAVES);
    }
    if (n == 0u && LISTS) {
        uint wanted = tile_starts[tiles.x * tiles.y];
        atomicAdd(counters.tile_leaves, wanted);
        atomicMax(counters.band_tile_leaves, wanted);
        if (wanted > frame.tile_leaf_capacity) atomicOr(counters.failed, FAILED_TILE_LEAVES);
    }
    if (LISTS && n % tiles.x == 0u) atomicMax(counters.row_tile_leaves, tile_starts[n + tiles.x] - start);
    if (LISTS && tile_starts[n + 1u] < start) {
        // the count exceeds 32 bits
        atomicMax(counters.band_tile_leaves, 0xffffffffu);
        atomicOr(counters.failed, FAILED_TILE_LEAVES);
    }
    uint steps = 0u;
    for (uint i = from; i < end; i += 4u) {
        ++steps;
        uint last = end - 1u;
        uvec4 at = min(i + uvec4(0u, 1u, 2u, 3u), uvec4(last));
        uvec4 leaf = uvec4(block_leaves[at.x], block_leaves[at.y], block_leaves[at.z], block_leaves[at.w]);
        look_at(leaf.x);
        if (i + 1u < end) look_at(leaf.y);
        if (i + 2u < end) look_at(leaf.z);
        if (i + 3u < end) look_at(leaf.w);
    }
    if (LISTS && from < end && steps != (end - from + 3u) / 4u) atomicAdd(counters.clamps, 1u);
    if (!LISTS) tile_counts[n] = count;
}
