#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_fold`: the Blist of each tile. The tile's points are outside the leaves that it does not show, so their
// out-exits are taken at once. One thread a tile. Twin: src/twin/solid_fold.rs.
//
//   Out-exits lead forward only, so they make a tree with EXIT_TRUE and EXIT_FALSE at its roots:
//
//     exit e ──▶ [absent] ──out──▶ [absent] ──out──▶ [present]     the first of e and its ancestors that is in the
//                                                                  tile's list
//
//   A leaf is a gate if no exit but EXIT_FALSE leads past it: a point that is not in it is outside.
//
//   Ancestors follow in Blist order; p is an ancestor of e if e lies in p's range of preorder numbers.
#include "scene.glsl"
#include "solids.glsl"
#include "tiles.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(scalar, binding = 2) readonly buffer TileStarts { uint tile_starts[]; };
layout(scalar, binding = 3) buffer TileLeaves { TileLeaf tile_leaves[]; };
layout(scalar, binding = 4) writeonly buffer TileEntries { uint tile_entries[]; };
layout(scalar, binding = 5) buffer CountersBuffer { Counters counters; };

// Number of tests: if a driver ends the loop early, some are missing.
uint asked = 0u;
uint answered = 0u;

// The first TileLeaf from `from` on whose leaf is not before `to`.
uint first_not_before(uint to, uint from, uint end) {
    while (from < end) {
        uint middle = (from + end) / 2u;
        if (tile_leaves[middle].leaf < to) from = middle + 1u;
        else end = middle;
    }
    return from;
}

// The tile's target of a walk to leaf or exit `to` of the whole Blist; `from` is the first possible TileLeaf. The
// search runs from both ends at once, since either may be long: the tile's leaves behind `to`, and the ancestors of
// `to`.
uint fold(uint to, uint from, uint end) {
    if (to >= EXIT_FALSE) return to;
    ++asked;
    Leaf target = leaves[to];
    uint found = (target.flags & LEAF_FALLS) != 0u ? EXIT_FALSE : EXIT_TRUE;
    uint seen = from < end && tile_leaves[from].leaf >= to ? from : first_not_before(to, from, end);
    uint ancestor = to;
    while (true) {
        if (seen >= end || ancestor >= EXIT_FALSE) {
            ++answered;
            break;
        }
        uint at = tile_leaves[seen].leaf;
        Leaf leaf = leaves[at];
        if (leaf.pre <= target.pre && target.pre < leaf.end) {
            found = seen;
            seen = end;
        } else {
            uint up = at < ancestor ? first_not_before(ancestor, seen + 1u, end) : end;
            bool is_seen = up < end && tile_leaves[up].leaf == ancestor;
            if (is_seen) found = up;
            seen = is_seen ? end : seen + 1u;
            ancestor = leaves[ancestor].out_exit;
        }
    }
    return found;
}

// Items that rays are followed through have lists of their own, one after another; the start of each is marked.
void main() {
    uint n = thread_number();
    uvec2 tiles = band_tiles(frame);
    if (n >= tiles.x * tiles.y) return;
    uint start = min(tile_starts[n], frame.tile_leaf_capacity);
    uint end = min(tile_starts[n + 1u], frame.tile_leaf_capacity);
    uint begin = fold(0u, start, end);
    tile_entries[first_of_band(frame) + n] = begin;
    uint reach = begin == EXIT_FALSE ? 0u : begin;
    uint item = EXIT_FALSE;
    uint entry = EXIT_FALSE;
    uint steps = 0u;
    for (uint i = start; i < end; ++i) {
        ++steps;
        uint at = tile_leaves[i].leaf;
        Leaf leaf = leaves[at];
        uint in_exit = fold(leaf.in_exit, i + 1u, end);
        uint out_exit = fold(leaf.out_exit, i + 1u, end);
        tile_leaves[i].in_exit = in_exit;
        tile_leaves[i].out_exit = out_exit;
        tile_leaves[i].of = leaf.first << LEAF_FLAG_BITS | leaf.flags & (1u << LEAF_FLAG_BITS) - 1u;
        if (at < frame.followed_leaf) {
            if (reach <= i) tile_leaves[i].leaf = at | TILE_LEAF_GATE; // no exit leads past it
            if (in_exit != EXIT_FALSE) reach = max(reach, in_exit);
            if (out_exit != EXIT_FALSE) reach = max(reach, out_exit);
            continue;
        }
        if (leaf.item != item) {
            item = leaf.item;
            entry = fold(item, i, end);
        }
        if (i == entry) tile_leaves[i].leaf = at | TILE_LEAF_ENTRY;
    }
    if (start < end && steps != end - start || answered != asked) atomicAdd(counters.clamps, 1u);
}
