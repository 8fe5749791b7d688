// Passes `solid_events` and, with FACE_IS_FOUND, `blister`: find the first depth at which the pixel's ray enters the
// Boolean solid.
//
//      ray ──┬──────────┬────┬─────────┬──▶     events: where the ray crosses a side of some leaf
//   A     ───┤██████████│████├─────────┼──
//   B     ───┼──────────┤████│█████████├──      coinciding sides share their surface, so their
//            ▲          ▲    ▲         ▲        depths are equal to the bit and make one event
//         in A?    the Blist is walked once behind each event
//
// The ray is followed from the near plane until outside becomes inside. A near plane within the solid cuts it open;
// then the first side entered from there is visible. Only the spans of the tile's first leaves are stored. Exits of a
// Blist lead forward, so one scan over the leaves decides both whether the solid is behind depth t and where the next
// relevant event is. The surfaces' equations are in one loop of their own, which skips stored spans: a driver that runs
// both sides of every branch does not solve them again. If the depth of the face is already known, the walk begins
// there and finds its owner.
//
// A driver may end a long loop early. Such a ray resumes from its last event when the same pass is drawn again: in
// segments. There are several segments only after a frame has reported that it needs them.
//
// An event is relevant only if it belongs to a leaf that the walk tests: until then the walk ends at the same leaf,
// whatever the other leaves are. In A - (B + C + ...) no other leaf is tested before A begins. While a gate of the
// tile's list is shut, only the gate is relevant: in (A + B + ...) - C the next event within C is its end.
#ifndef SOLID_EVENTS_GLSL
#define SOLID_EVENTS_GLSL

#include "scene.glsl"
#include "solids.glsl"
#include "shells.glsl"
#include "tiles.glsl"
#include "eye_ray.glsl"
#include "view.glsl"
#include "visible.glsl"
#include "words.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(binding = 2) uniform usamplerBuffer leaf_surfaces;
layout(binding = 3) uniform samplerBuffer surfaces;
layout(binding = 4) uniform samplerBuffer surface_places;
layout(binding = 5) uniform usamplerBuffer tile_starts;
layout(binding = 6) uniform usamplerBuffer tile_leaves;
layout(binding = 7) uniform usamplerBuffer tile_entries;

layout(scalar, binding = 8) readonly buffer FragmentStarts { uint fragment_starts[]; };
layout(scalar, binding = 9) readonly buffer FragmentCounts { uint fragment_counts[]; };
layout(binding = 10) uniform usamplerBuffer fragments;

layout(scalar, binding = 11) buffer CountersBuffer { Counters counters; };

#ifdef FACE_IS_FOUND
layout(binding = 12, rg32ui) readonly uniform uimage2D found;
#endif

#ifndef FACE_IS_FOUND
layout(scalar, binding = 13) buffer ResumePoints { uint resume_points[]; }; // of each pixel; bound if there are several ray segments
layout(scalar, push_constant) uniform Legs {
    uint nth;     // this segment, from 0
    uint ray_segments;    // of this drawing
    uint is_most; // a frame may not request more
};

// A resume point: the depth of the event from which the next segment continues, with the sign bit set if the solid is
// in front of it; 0 if the ray is finished.
const uint RESUME_BEFORE = 0x80000000u;
#endif

// Whether some leaf is a shell; the code for shells is compiled in only then.
layout(constant_id = 13) const bool SOLIDS_HAVE_SHELLS = true;

// Whether lists of items that rays are followed through come after the union's.
layout(constant_id = 14) const bool SOLIDS_ARE_FOLLOWED = false;

#include "crossing.glsl"
#include "leaf_span.glsl"

layout(location = 0) out uvec2 visible;
layout(location = 1) out uint operand_uv; // of a spline face, in scenes with spline operands

const uint NOBODY = 0xffffffffu;

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

void main() {
    uint pixel = pixel_in_band(frame, uvec2(gl_FragCoord.xy));
#ifndef FACE_IS_FOUND
    uint resume_point = 0u;
    if (nth > 0u) {
        resume_point = resume_points[pixel];
        if (resume_point == 0u) discard;
    }
#endif
    uint n = tile_in_band(frame, uvec2(gl_FragCoord.xy));
    uint first = min(word_at(tile_starts, n), frame.tile_leaf_capacity);
    uint end = min(word_at(tile_starts, n + 1u), frame.tile_leaf_capacity);
    if (SOLIDS_ARE_FOLLOWED) {
        while (end > first && leaf_number(tile_leaf_at(tile_leaves, end - 1u)) >= frame.followed_leaf) --end;
    }
    uint entry = word_at(tile_entries, first_of_band(frame) + n);
    if (entry == EXIT_FALSE) discard;
    Ray ray = eye_ray(frame, gl_FragCoord.xy);
    uint first_fragment = SOLIDS_HAVE_SHELLS ? fragment_starts[pixel] : 0u;
    uint fragment_count = SOLIDS_HAVE_SHELLS ? fragment_counts[pixel] : 0u;
    Span kept[KEPT];
    uint purpose = SEARCH;
    uint asked = NOBODY;
    uint after = 0u;        // candidates from here on
    uint fallback = NOBODY;
    bool negatives = false; // the candidates are the subtracted leaves
    uint side = 0u;
    uint word = SEEN_SOLID;
    operand_uv = 0u;
    float t = frame.near;
    bool before = true; // the near plane cuts the solid: what is inside there is not entered
#ifdef FACE_IS_FOUND
    uvec2 face = imageLoad(found, ivec2(gl_FragCoord.xy)).xy;
    if (face.x == 0u) discard;
    t = uintBitsToFloat(face.y);
    before = false;
#else
    if (nth > 0u) {
        before = (resume_point & RESUME_BEFORE) != 0u;
        t = uintBitsToFloat(resume_point & ~RESUME_BEFORE);
    }
    float begun = t;
    bool begun_before = before;
#endif
    // four events a leaf, at most as many tests of owners, and one for the side
    uint most = 8u * (end - first) + 2u * fragment_count + 4u;
    bool done = false;
    bool passed = false; // the far plane
    uint two = min(end - first, 1u) + 1u;
    for (uint scan = 0u; scan < most && !done; ++scan) {
        // the spans of [first, known) are stored, those of [from, to) computed: all at first, later those that are not
        // stored, and that of leaf `asked`, to find its side
        bool tells = purpose == SIDE;
        uint from = tells ? asked : scan == 0u ? first : min(first + KEPT, end);
        uint to = !tells ? end : asked == NOBODY ? from : asked + 1u;
        uint known = tells ? first : from;
        Walk walk = Walk(entry, entry, NEVER, Candidates(NOBODY, NOBODY), 0u);
        for (uint i = first; i < known; ++i) {
            TileLeaf here = tile_leaf_at(tile_leaves, i);
            Crossing c;
            uint last;
            if (SOLIDS_HAVE_SHELLS && (here.of & LEAF_SHELL) != 0u) {
                c = crossing_of(here.of >> LEAF_FLAG_BITS, t, first_fragment, fragment_count, last);
            } else {
                c = crossing_of(kept[i - first], t);
            }
            meet(walk, i, here, c, purpose == OWNER ? asked : NOBODY, after);
        }
        for (uint i = from; i < to; ++i) {
            TileLeaf here = tile_leaf_at(tile_leaves, i);
            Crossing c;
            if (SOLIDS_HAVE_SHELLS && (here.of & LEAF_SHELL) != 0u) {
                uint last;
                c = crossing_of(here.of >> LEAF_FLAG_BITS, t, first_fragment, fragment_count, last);
                if (tells) {
                    Fragment f = fragment_at(fragments, last);
                    side = f.what;
                    word = (f.shell & FRAGMENT_PATCH) != 0u ? SEEN_OPERAND : SEEN_SOLID;
                    operand_uv = f.uv;
                }
            } else {
                Span s = leaf_span(here.of, ray.o, ray.d, t, side);
                if (i - first < KEPT) kept[i - first] = s;
                c = crossing_of(s, t);
            }
            meet(walk, i, here, c, purpose == OWNER ? asked : NOBODY, after);
        }
        // a driver that has ended a loop ends all later loops, too, including this one of two steps; the scan is then
        // invalid
        uint steps = 0u;
        for (uint i = 0u; i < two; ++i) ++steps;
        if (steps != two) break;
        bool inside = walk.at == EXIT_TRUE;
        if (purpose == SIDE) {
            done = true;
        } else if (purpose == OWNER) {
            // the owner is the first leaf that by itself changes the solid, in front of the event or behind it
            uint other = negatives ? walk.found.negative : walk.found.positive;
            if (!inside || walk.at_before == EXIT_TRUE) {
                purpose = SIDE;
            } else if (other != NOBODY) {
                asked = other;
                after = other + 1u;
            } else if (!negatives) {
                negatives = true;
                asked = NOBODY; // again from the first leaf, for subtracted leaves
                after = first;
            } else {
                asked = fallback;
                purpose = SIDE;
            }
        } else if (inside && !before) {
            asked = min(walk.found.positive, walk.found.negative);
            if (walk.found.positive != NOBODY) asked = walk.found.positive;
            fallback = asked;
            after = asked + 1u;
            negatives = walk.found.positive == NOBODY;
            purpose = walk.candidates > 1u ? OWNER : SIDE;
        } else {
            if (walk.next >= frame.far) {
                passed = true;
                break;
            }
            before = inside;
            t = walk.next;
        }
    }
    bool ended = done || passed;
#ifdef FACE_IS_FOUND
    if (!ended) atomicAdd(counters.clamps, 1u);
#else
    // resume from the event of the last valid scan, if it is farther on
    bool goes_on = !ended && (t > begun || t == begun && before != begun_before);
    if (goes_on) atomicMax(counters.ray_segments, nth + 1u);
    if (ray_segments > 1u) resume_points[pixel] = goes_on ? floatBitsToUint(t) | (before ? RESUME_BEFORE : 0u) : 0u;
    if (goes_on && nth + 1u == ray_segments && is_most == 0u) atomicOr(counters.failed, FAILED_RAY_SEGMENTS);
    else if (!ended && (!goes_on || nth + 1u == ray_segments)) atomicAdd(counters.clamps, 1u);
#endif
    if (!done) discard;
    visible = uvec2(word | side, floatBitsToUint(t));
    gl_FragDepth = reversed_depth(frame, t) / (frame.perspective != 0u ? t : 1.0);
}

#endif
