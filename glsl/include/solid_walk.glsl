// The walk of a ray from event to event of a Boolean solid, for passes `solid_events` and `border_solid`:
// solid_events.glsl says how it goes. Needs solids.glsl, boundary_operands.glsl, tiles.glsl, crossing.glsl,
// leaf_span.glsl, visible.glsl, eye_ray.glsl, `frame` and `usamplerBuffer tile_starts`, `tile_leaves`, `tile_entries`.
#ifndef SOLID_WALK_GLSL
#define SOLID_WALK_GLSL

// Whether lists of items that rays are followed through come after the union's.
layout(constant_id = 14) const bool SOLIDS_ARE_FOLLOWED = false;

const uint NO_LEAF = 0xffffffffu;

// Number of stored spans; those of further leaves are computed in every scan.
const uint KEPT = 12u;

// The purpose of a scan.
const uint SEARCH = 0u; // the next event
const uint OWNER = 1u;  // whether flipping leaf `asked` changes the solid before or behind t
const uint SIDE = 2u;   // the side of leaf `asked` that ends at t

// The first positive leaf, and the first subtracted leaf, whose spans begin or end at depth t.
struct Candidates {
    uint positive;
    uint negative;
};

// One scan over the tile's leaves.
struct Walk {
    uint at;        // behind depth t
    uint at_before; // in front of it
    float next;     // the next depth at which a leaf that the walk behind t tests begins or ends
    Candidates found;
    uint candidates;
};

// Adds leaf i of the tile at depth t; leaf `other` is flipped, and candidates start after `after`.
void meet(inout Walk walk, uint i, TileLeaf here, Crossing c, uint other, uint after) {
    if (i == walk.at) {
        walk.at = c.inside != (i == other) ? here.in_exit : here.out_exit;
        bool shut = walk.at == EXIT_FALSE && (here.leaf & TILE_LEAF_GATE) != 0u;
        walk.next = shut ? c.next : min(walk.next, c.next);
    }
    if (i == walk.at_before) walk.at_before = c.before != (i == other) ? here.in_exit : here.out_exit;
    if (i < after || !c.ends) return;
    ++walk.candidates;
    if ((here.of & LEAF_NEGATIVE) != 0u) walk.found.negative = min(walk.found.negative, i);
    else walk.found.positive = min(walk.found.positive, i);
}

// What the ray may meet: leaves of its tile, where their walk begins, and fragments of its pixel.
struct Meets {
    uint first;
    uint end;
    uint entry;
    uint first_fragment;
    uint fragment_count;
};

// Of the tile of a pixel in the band: the leaves of the union that is seen, without those of items that rays are
// followed through. No fragments.
Meets leaves_at(uvec2 pixel) {
    uint n = tile_in_band(frame, pixel);
    uint first = min(word_at(tile_starts, n), frame.tile_leaf_capacity);
    uint end = min(word_at(tile_starts, n + 1u), frame.tile_leaf_capacity);
    if (SOLIDS_ARE_FOLLOWED) {
        while (end > first && leaf_number(tile_leaf_at(tile_leaves, end - 1u)) >= frame.followed_leaf) --end;
    }
    return Meets(first, end, word_at(tile_entries, first_of_band(frame) + n), 0u, 0u);
}

// How far the ray has come.
struct Progress {
    float t;
    bool before;     // the solid is in front of t
    bool done;       // t is where the solid is entered, by this side:
    bool passed;     // the far plane
    uint side;
    uint word;       // kind of what is seen
    uint operand_uv; // of a spline face
};

// At the near plane, which cuts: what is inside there is not entered.
Progress begin_walk() { return Progress(frame.near, true, false, false, 0u, SEEN_SOLID, 0u); }

// Goes on until the solid is entered, or passed.
void follow(inout Progress p, Meets meets, Ray ray) {
    Span kept[KEPT];
    uint purpose = SEARCH;
    uint asked = NO_LEAF;
    uint after = 0u;        // candidates from here on
    uint fallback = NO_LEAF;
    bool negatives = false; // the candidates are the subtracted leaves
    // four events a leaf, at most as many tests of owners, and one for the side
    uint most = 8u * (meets.end - meets.first) + 2u * meets.fragment_count + 4u;
    uint two = min(meets.end - meets.first, 1u) + 1u;
    for (uint scan = 0u; scan < most && !p.done; ++scan) {
        // the spans of [meets.first, known) are kept, those of [from, to) computed: all at first, then what is not
        // kept, and the asked leaf's again to tell its side
        bool tells = purpose == SIDE;
        uint from = tells ? asked : scan == 0u ? meets.first : min(meets.first + KEPT, meets.end);
        uint to = !tells ? meets.end : asked == NO_LEAF ? from : asked + 1u;
        uint known = tells ? meets.first : from;
        Walk walk = Walk(meets.entry, meets.entry, NEVER, Candidates(NO_LEAF, NO_LEAF), 0u);
        for (uint i = meets.first; i < known; ++i) {
            TileLeaf here = tile_leaf_at(tile_leaves, i);
            Crossing c;
            uint last;
            if (SOLIDS_HAVE_BOUNDARY_OPERANDS && (here.of & LEAF_BOUNDARY) != 0u) {
                c = crossing_of(here.of >> LEAF_FLAG_BITS, p.t, meets.first_fragment, meets.fragment_count, last);
            } else {
                c = crossing_of(kept[i - meets.first], p.t);
            }
            meet(walk, i, here, c, purpose == OWNER ? asked : NO_LEAF, after);
        }
        for (uint i = from; i < to; ++i) {
            TileLeaf here = tile_leaf_at(tile_leaves, i);
            Crossing c;
            if (SOLIDS_HAVE_BOUNDARY_OPERANDS && (here.of & LEAF_BOUNDARY) != 0u) {
                uint last;
                c = crossing_of(here.of >> LEAF_FLAG_BITS, p.t, meets.first_fragment, meets.fragment_count, last);
                if (tells) {
                    Fragment f = fragment_at(fragments, last);
                    p.side = f.what;
                    p.word = (f.operand & FRAGMENT_PATCH) != 0u ? SEEN_OPERAND : SEEN_SOLID;
                    p.operand_uv = f.uv;
                }
            } else {
                Span s = leaf_span(here.of, ray.o, ray.d, p.t, p.side);
                if (i - meets.first < KEPT) kept[i - meets.first] = s;
                c = crossing_of(s, p.t);
            }
            meet(walk, i, here, c, purpose == OWNER ? asked : NO_LEAF, after);
        }
        // a driver that has ended a loop ends all later loops, too, including this one of two steps; the scan is then
        // invalid
        uint steps = 0u;
        for (uint i = 0u; i < two; ++i) ++steps;
        if (steps != two) break;
        bool inside = walk.at == EXIT_TRUE;
        if (purpose == SIDE) {
            p.done = true;
        } else if (purpose == OWNER) {
            // the owner is the first leaf that by itself changes the solid, in front of the event or behind it
            uint other = negatives ? walk.found.negative : walk.found.positive;
            if (!inside || walk.at_before == EXIT_TRUE) {
                purpose = SIDE;
            } else if (other != NO_LEAF) {
                asked = other;
                after = other + 1u;
            } else if (!negatives) {
                negatives = true;
                asked = NO_LEAF; // from the beginning, for subtracted leaves
                after = meets.first;
            } else {
                asked = fallback;
                purpose = SIDE;
            }
        } else if (inside && !p.before) {
            asked = min(walk.found.positive, walk.found.negative);
            if (walk.found.positive != NO_LEAF) asked = walk.found.positive;
            fallback = asked;
            after = asked + 1u;
            negatives = walk.found.positive == NO_LEAF;
            purpose = walk.candidates > 1u ? OWNER : SIDE;
        } else {
            if (walk.next >= frame.far) {
                p.passed = true;
                break;
            }
            p.before = inside;
            p.t = walk.next;
        }
    }
}

#endif
