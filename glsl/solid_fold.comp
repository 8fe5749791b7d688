#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_fold`: the Blist of each tile: a leaf that the tile does not see is one whose outside
// the point is in, so its out-exit is taken at once. One thread a tile.
// Twin: src/twin/solid_fold.rs.
//
//   Out-exits lead forward only, so they make a tree with EXIT_TRUE and EXIT_FALSE at its roots:
//
//     exit e ──▶ [absent] ──out──▶ [absent] ──out──▶ [present]     the first ancestor of e, or e itself,
//                                                                  that the tile sees
//
//   Ancestors follow in Blist order, and p is one of e when e lies in p's range of preorder numbers.
#include "scene.glsl"
#include "solids.glsl"
#include "tiles.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(scalar, binding = 2) readonly buffer TileStarts { uint tile_starts[]; };
layout(scalar, binding = 3) buffer TileLeaves { TileLeaf tile_leaves[]; };
layout(scalar, binding = 4) writeonly buffer TileEntries { uint tile_entries[]; };

// Where a walk that goes to leaf or exit `to` of the whole Blist goes in the tile; `from` is the first
// TileLeaf that it can be.
uint fold(uint to, uint from, uint end) {
    if (to >= EXIT_FALSE) return to;
    uint pre = leaves[to].pre;
    for (uint i = from; i < end; ++i) {
        Leaf leaf = leaves[tile_leaves[i].leaf];
        if (tile_leaves[i].leaf >= to && leaf.pre <= pre && pre < leaf.end) return i;
    }
    return (leaves[to].flags & LEAF_FALLS) != 0u ? EXIT_FALSE : EXIT_TRUE;
}

// Items that rays are followed through are lists of their own, one after another: where each begins is marked.
void main() {
    uint n = gl_GlobalInvocationID.x;
    uvec2 tiles = band_tiles(frame);
    if (n >= tiles.x * tiles.y) return;
    uint start = min(tile_starts[n], frame.tile_leaf_capacity);
    uint end = min(tile_starts[n + 1u], frame.tile_leaf_capacity);
    tile_entries[first_of_band(frame) + n] = fold(0u, start, end);
    uint item = EXIT_FALSE;
    uint entry = EXIT_FALSE;
    for (uint i = start; i < end; ++i) {
        uint at = tile_leaves[i].leaf;
        Leaf leaf = leaves[at];
        tile_leaves[i].in_exit = fold(leaf.in_exit, i + 1u, end);
        tile_leaves[i].out_exit = fold(leaf.out_exit, i + 1u, end);
        tile_leaves[i].of = leaf.first << LEAF_FLAG_BITS | leaf.flags;
        if (at < frame.followed_leaf) continue;
        if (leaf.item != item) {
            item = leaf.item;
            entry = fold(item, i, end);
        }
        if (i == entry) tile_leaves[i].leaf = at | TILE_LEAF_ENTRY; // nobody looks back at it
    }
}
