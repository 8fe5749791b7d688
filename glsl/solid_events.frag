#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_events`: the first depth at which the pixel's ray enters the Boolean solid.
//
//      ray ──┬──────────┬────┬─────────┬──▶     events: where the ray crosses a side of some leaf
//   A     ───┤██████████│████├─────────┼──
//   B     ───┼──────────┤████│█████████├──      sides that coincide share their surface, so their
//            ▲          ▲    ▲         ▲        depths are equal to the bit and make one event
//         in A?    the Blist is walked once behind each event
//
// The ray is followed until outside becomes inside. No event is stored: the next one is the smallest
// depth behind the last, over the leaves of the tile.
#include "scene.glsl"
#include "solids.glsl"
#include "tiles.glsl"
#include "eye_ray.glsl"
#include "visible.glsl"

layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(scalar, binding = 2) readonly buffer LeafSurfaces { LeafSurface leaf_surfaces[]; };
layout(scalar, binding = 3) readonly buffer Surfaces { Surface surfaces[]; };
layout(scalar, binding = 4) readonly buffer SurfaceCentres { vec3 surface_centres[]; };
layout(scalar, binding = 5) readonly buffer TileStarts { uint tile_starts[]; };
layout(scalar, binding = 6) readonly buffer TileLeaves { TileLeaf tile_leaves[]; };
layout(scalar, binding = 7) readonly buffer TileEntries { uint tile_entries[]; };

layout(location = 0) out uvec2 visible;

const uint NOBODY = 0xffffffffu;

// Spans kept; those of further leaves are computed whenever they are asked for.
const uint KEPT = 12u;

Span kept[KEPT];
Ray ray;
uint first;
uint end;

// One side of a leaf.
Span side_span(LeafSurface side) {
    uint at = side.surface >> 1;
    Span s = surface_span(surfaces[at], ray.o - surface_centres[at], ray.d);
    if ((side.surface & 1u) != 0u) return complement(s);
    return s;
}

Span leaf_span(uint n) {
    Leaf leaf = leaves[n];
    Span s = EVERYTHING;
    for (uint i = leaf.first; i < leaf.first + leaf.count && s.lo < s.hi; ++i) {
        s = both(s, side_span(leaf_surfaces[i]));
    }
    return s;
}

Span span_of(uint i) {
    if (i - first < KEPT) return kept[i - first];
    return leaf_span(tile_leaves[i].leaf);
}

// Inside of the solid just behind depth t, with one leaf taken for what it is not.
bool inside_solid(uint entry, float t, uint flipped) {
    uint at = entry;
    while (at < end) {
        bool in_ = inside_span(span_of(at), t) != (at == flipped);
        at = in_ ? tile_leaves[at].in_exit : tile_leaves[at].out_exit;
    }
    return at == EXIT_TRUE;
}

// Who owns the surface at depth t: of the leaves that begin or end there the first without which
// the solid would not begin; positive ones before subtracted ones.
uint owner_at(uint entry, float t) {
    uint best = NOBODY;
    uint best_rank = 4u;
    for (uint i = first; i < end; ++i) {
        Span s = span_of(i);
        if (s.lo != t && s.hi != t && s.g0 != t && s.g1 != t) continue;
        uint leaf = tile_leaves[i].leaf;
        uint rank = (leaves[leaf].flags & LEAF_NEGATIVE) != 0u ? 1u : 0u;
        if (inside_solid(entry, t, i)) rank += 2u;
        if (rank < best_rank) {
            best = leaf;
            best_rank = rank;
        }
    }
    return best;
}

// The side of the leaf that the ray crosses at depth t.
uint side_at(uint n, float t) {
    Leaf leaf = leaves[n];
    for (uint i = leaf.first; i < leaf.first + leaf.count; ++i) {
        Span s = side_span(leaf_surfaces[i]);
        if (s.lo == t || s.hi == t || s.g0 == t || s.g1 == t) return i;
    }
    return leaf.first;
}

void main() {
    uvec2 tiles = tile_count(frame);
    uvec2 tile = uvec2(gl_FragCoord.xy) / TILE;
    uint n = tile.y * tiles.x + tile.x;
    first = min(tile_starts[n], frame.tile_leaf_capacity);
    end = min(tile_starts[n + 1u], frame.tile_leaf_capacity);
    uint entry = tile_entries[n];
    if (entry == EXIT_FALSE) discard;
    ray = eye_ray(frame, gl_FragCoord.xy);
    for (uint i = 0u; i < KEPT; ++i) {
        if (first + i < end) kept[i] = leaf_span(tile_leaves[first + i].leaf);
    }
    float t = frame.near;
    bool before = inside_solid(entry, t, NOBODY);
    bool found = false;
    // each leaf has at most four events
    for (uint step_ = 0u; step_ <= 4u * (end - first) && !found; ++step_) {
        float next = NEVER;
        for (uint i = first; i < end; ++i) next = min(next, next_of_span(span_of(i), t));
        if (next >= frame.far) break;
        t = next;
        bool behind = inside_solid(entry, t, NOBODY);
        found = behind && !before;
        before = behind;
    }
    if (!found) discard;
    visible = uvec2(SOLID | (side_at(owner_at(entry, t), t) + 1u), floatBitsToUint(t));
    gl_FragDepth = reversed_depth(frame, t);
}
