#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_tiles`: which leaves each tile of the band may see, of those of its block: counted first,
// then listed. One thread a tile.
// Twin: src/twin/solid_tiles.rs.
#include "scene.glsl"
#include "tiles.glsl"

layout(constant_id = 6) const bool LISTS = false;

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Rects { Rect rects[]; };
layout(scalar, binding = 2) readonly buffer BlockStarts { uint block_starts[]; };
layout(scalar, binding = 3) readonly buffer BlockLeaves { uint block_leaves[]; };
layout(scalar, binding = 4) buffer TileCounts { uint tile_counts[]; };
layout(scalar, binding = 5) readonly buffer TileStarts { uint tile_starts[]; };
layout(scalar, binding = 6) writeonly buffer TileLeaves { TileLeaf tile_leaves[]; };
layout(scalar, binding = 7) buffer CountersBuffer { Counters counters; };

void main() {
    uint n = gl_GlobalInvocationID.x;
    uvec2 tiles = band_tiles(frame);
    if (n >= tiles.x * tiles.y) return;
    uvec2 tile = uvec2(n % tiles.x, frame.band_top / TILE + n / tiles.x);
    uvec2 blocks = block_count(frame);
    uint block = tile.y / BLOCK * blocks.x + tile.x / BLOCK;
    uint start = LISTS ? tile_starts[n] : 0u;
    uint count = 0u;
    uint end = block_starts[block + 1u];
    if (n == 0u && !LISTS) {
        uint wanted = block_starts[blocks.x * blocks.y];
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
        // more than 32 bits count
        atomicMax(counters.band_tile_leaves, 0xffffffffu);
        atomicOr(counters.failed, FAILED_TILE_LEAVES);
    }
    for (uint i = block_starts[block]; i < min(end, frame.block_leaf_capacity); ++i) {
        uint leaf = block_leaves[i];
        if (!meets(rects[leaf], tile, tile)) continue;
        if (LISTS && start + count < frame.tile_leaf_capacity) tile_leaves[start + count].leaf = leaf;
        ++count;
    }
    if (!LISTS) tile_counts[n] = count;
}
