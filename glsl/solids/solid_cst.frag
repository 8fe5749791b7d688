#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_cst`: the faces of one leaf, trimmed by the others.
//
//      ray ──┬──────────┬─────────┬──▶
//   leaf   ──┼──────────┤█████████├──    up to four ends
//            ▲          ▲         ▲
//            │     outside in front, inside behind: a face of the solid is here
//      the tile's Blist, walked in front of the end and behind it
//
// The walk visits only the leaves that its exits lead to, and stores nothing. The depth test finds the nearest face. A
// leaf owns a face if by itself it changes the solid there, in front or behind: with the leaf flipped, the walk ends
// differently (the Boolean derivative, whose inside is the leaf's active zone). Everything is one loop, so that the
// surfaces' equations are compiled once.
#include "scene.glsl"
#include "solids.glsl"
#include "tiles.glsl"
#include "trimmed_leaf.glsl"
#include "eye_ray.glsl"
#include "view.glsl"
#include "visible.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(binding = 2) uniform usamplerBuffer leaf_surfaces;
layout(binding = 3) uniform samplerBuffer surfaces;
layout(binding = 4) uniform samplerBuffer surface_places;
layout(scalar, binding = 5) readonly buffer TileStarts { uint tile_starts[]; };
layout(binding = 6) uniform usamplerBuffer tile_leaves;
layout(scalar, binding = 7) readonly buffer TileEntries { uint tile_entries[]; };

layout(scalar, binding = 10) buffer CountersBuffer { Counters counters; };

layout(location = 0) flat in uint ordered;
#include "leaf_span.glsl"

layout(location = 0) out uvec2 visible;

// The purpose of a step of the loop.
const uint OWN = 0u;  // the leaf's own span
const uint WALK = 1u; // the next leaf of the Blist, at an end of the span
const uint SIDE = 2u; // the side that ends there

// The places of the walks: in front of the end and behind it, then the same with the leaf flipped.
struct Walks {
    uint before;
    uint behind;
    uint before_flipped;
    uint behind_flipped;
};

float end_of(Span s, uint k) { return k == 0u ? s.lo : k == 1u ? s.g0 : k == 2u ? s.g1 : s.hi; }

void main() {
    uint n = tile_in_band(frame, uvec2(gl_FragCoord.xy));
    uint first = min(tile_starts[n], frame.tile_leaf_capacity);
    uint end = min(tile_starts[n + 1u], frame.tile_leaf_capacity);
    uint entry = tile_entries[first_of_band(frame) + n];
    if (entry >= EXIT_FALSE) discard; // the same everywhere in the tile
    uint own = ordered & LEAF_OF;
    Ray ray = eye_ray(frame, gl_FragCoord.xy);
    Span mine = NOTHING;
    uint purpose = OWN;
    uint tried = 0u; // ends
    float t = 0.0;
    Walks at = Walks(EXIT_FALSE, EXIT_FALSE, EXIT_FALSE, EXIT_FALSE);
    uint side = 0u;
    bool found = false;
    bool none = false; // all ends are tried
    TileLeaf itself = TileLeaf(own, EXIT_FALSE, EXIT_FALSE, leaves[own].first << LEAF_FLAG_BITS | leaves[own].flags);
    // for each end, the walks pass each leaf at most once
    uint most = 4u * (end - first) + 8u;
    for (uint step_ = 0u; step_ < most && !found; ++step_) {
        uint next = min(min(at.before, at.behind), min(at.before_flipped, at.behind_flipped));
        if (purpose == WALK && next >= EXIT_FALSE) {
            bool appears = at.before == EXIT_FALSE && at.behind == EXIT_TRUE;
            bool owns = at.before_flipped == EXIT_TRUE || at.behind_flipped == EXIT_FALSE;
            if (appears && (owns || (ordered & UNOWNED) != 0u)) {
                purpose = SIDE;
            } else {
                // the next end between the near plane and the far one
                bool valid = false;
                while (!valid && tried < 4u) {
                    t = end_of(mine, tried);
                    bool gap = tried == 1u || tried == 2u;
                    valid = t > frame.near && t < frame.far && mine.lo < mine.hi && (!gap || mine.g0 < mine.g1);
                    ++tried;
                }
                if (!valid) {
                    none = tried == 4u;
                    break;
                }
                at = Walks(entry, entry, entry, entry);
                next = entry;
            }
        }
        TileLeaf here = itself;
        if (purpose == WALK) here = tile_leaf_at(tile_leaves, next);
        bool is_own = leaf_number(here) == own;
        Span s = mine;
        if (purpose != WALK || !is_own) s = leaf_span(here.of, ray.o, ray.d, t, side);
        if (purpose == SIDE) {
            found = true;
        } else if (purpose == OWN) {
            mine = s;
            purpose = WALK;
        } else {
            bool before = inside_before(s, t);
            bool behind = inside_span(s, t);
            if (at.before == next) at.before = before ? here.in_exit : here.out_exit;
            if (at.behind == next) at.behind = behind ? here.in_exit : here.out_exit;
            if (at.before_flipped == next) at.before_flipped = before != is_own ? here.in_exit : here.out_exit;
            if (at.behind_flipped == next) at.behind_flipped = behind != is_own ? here.in_exit : here.out_exit;
        }
    }
    // count leaves whose loops a driver ended
    if (!(found || none)) atomicAdd(counters.clamps, 1u);
    if (!found) discard;
    visible = uvec2(SEEN_SOLID | side, floatBitsToUint(t));
    gl_FragDepth = reversed_depth(frame, t) / (frame.perspective != 0u ? t : 1.0);
}
