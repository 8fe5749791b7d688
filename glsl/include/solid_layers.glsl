// Pass `solid_layers`: follows the pixel's ray from face to face through distinct solids.
//
//      ray ──┬────────┬─────┬──────┬───┬───▶    opaque: the surface of pass `resolve` ends the ray
//   glass   ─┤░░░░░░░░░░░░░░░░░░░░░│   │
//   within  ─┼────────┤▓▓▓▓▓│──────┼───┤▓▓      each face is a layer: colour += (1 - opacity so far) * its own
//
// Every item has its own list of switches. One scan over the tile's leaves walks all of them, in front of depth t and
// behind it. Items that change there are shaded one after another: first those that the ray leaves, then those that it
// enters, both in their order. An opaque face at the same depth comes between the two. Everything is one loop, so that
// the surfaces' equations are compiled once.
#ifndef SOLID_LAYERS_GLSL
#define SOLID_LAYERS_GLSL

#include "scene.glsl"
#include "solids.glsl"
#include "boundary_operands.glsl"
#include "tiles.glsl"
#include "view.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(binding = 2) uniform usamplerBuffer leaf_surfaces;
layout(binding = 3) uniform samplerBuffer surfaces;
layout(binding = 4) uniform samplerBuffer surface_places;
layout(scalar, binding = 5) readonly buffer LeafCentres { vec3 leaf_centres[]; };
layout(scalar, binding = 6) readonly buffer TileStarts { uint tile_starts[]; };
layout(binding = 7) uniform usamplerBuffer tile_leaves;
layout(scalar, binding = 8) readonly buffer FragmentStarts { uint fragment_starts[]; };
layout(scalar, binding = 9) readonly buffer FragmentCounts { uint fragment_counts[]; };
layout(binding = 10) uniform usamplerBuffer fragments;
layout(scalar, binding = 11) buffer CountersBuffer { Counters counters; };
layout(binding = 12, rgba32f) readonly uniform image2D behind; // linear colour, depth; for background UNSEEN, or less an
// opacity if it is mixed with what is beside it (pass `border_write`)
// of spline operands
layout(scalar, binding = 13) readonly buffer Views { View views[]; };
layout(scalar, binding = 14) readonly buffer FaceInstances { FaceInstance face_instances[]; };
layout(scalar, binding = 15) readonly buffer Faces { Face faces[]; };
#define PATCHES_BINDING 16
#include "patches.glsl"
layout(scalar, binding = 17) readonly buffer PatchInstances { uint patch_instances[]; };
layout(binding = 18) uniform samplerBuffer points;
layout(scalar, binding = 19) readonly buffer Instances { Instance instances[]; };
// of mesh operands
layout(scalar, binding = 20) readonly buffer OperandMeshes { OperandMesh operand_meshes[]; };
layout(scalar, binding = 21) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 22) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = 23) readonly buffer Planes { uint planes[]; };

layout(scalar, push_constant) uniform Push {
    vec4 contact;  // linear colour and opacity of pixels whose rays meet coincident faces of two items
    vec4 overlap;  // of pixels whose rays are within two items at once
    uint nth;      // FOR_NTH: the face's number from the eye on; the nearest has 1
};

// The output for which the ray is followed.
const uint FOR_COLOUR = 0u;    // the pixel's colour
const uint FOR_FIRST = 1u;     // the images of the first face that is not fully transparent
const uint FOR_THICKNESS = 2u; // its length within solids
const uint FOR_NTH = 3u;       // the nth face that is seen through, packed: layer_words.glsl
const uint FOR_BACK = 4u;      // the farthest one in front of what is opaque
layout(constant_id = 15) const uint FOLLOWED_FOR = FOR_COLOUR;
// Whether contacts and overlaps are marked; only for colour.
layout(constant_id = 16) const bool MARKS = false;
layout(constant_id = 17) const bool SOLIDS_HAVE_PATCHES = false;

#include "crossing.glsl"
#include "leaf_span.glsl"
#include "eye_ray.glsl"
#include "patch.glsl"
#include "resolved.glsl"
#include "refine.glsl"

#include "patch_normal.glsl"
#include "visible.glsl"
#include "layer_words.glsl"
#include "sides.glsl"

const uint NOBODY = 0xffffffffu;

#include "convex_run.glsl"

// Number of stored spans; those of further leaves are computed in every scan that comes near their boxes.
const uint KEPT = 12u;

// A smaller share of the colours behind changes no colour of eight bits: sRGB's slope of 12.92 at black, times 255.
const float OPAQUE = 1.0 / 8192.0;

// Relative depth within which a face of an operand without equations touches an opaque face: some ten times the error
// of a spline's depth after Newton's method.
const float TOUCHES = 1.0 / 65536.0;

// Rounding of a box relative to the eye, as a share of its depth.
const float BOX = 1e-6;

// The purpose of a scan.
const uint SEARCH = 0u; // the items that change at t, and the next event
const uint OWNER = 1u;  // whether flipping leaf `asked` changes its item before or behind t
const uint SIDE = 2u;   // the side of leaf `asked` that ends at t

// An item during a scan.
struct Walk {
    uint item;      // its first leaf
    uint from;      // in the tile
    uint at;        // behind t
    uint at_before; // in front of it
    uint positive;  // the first leaves that begin or end there: one that adds, one that subtracts
    uint negative;
    uint candidates;
    bool lives;     // some of it is still ahead
};

// A face of an item.
struct Change {
    uint key;       // in the order of layers; 0: none
    uint from;
    uint end;
    uint positive;
    uint negative;
    uint candidates;
};

const uint ENTERED = 0x80000000u;

Change best;   // the first change after `done_key`
uint changes; // items that change at t
uint left;    // those of them after `done_key`
uint within;  // items behind t
uint live_from; // start of the remaining leaves: items that the ray has passed no longer change anything
uint live_end;

void close_item(Walk w, uint end, uint first, uint done_key, bool asks) {
    if (w.item == NOBODY) return;
    bool now = w.at == EXIT_TRUE;
    within += now ? 1u : 0u;
    if (now || w.lives) {
        live_from = min(live_from, w.from);
        live_end = end;
    }
    if (!asks || now == (w.at_before == EXIT_TRUE)) return;
    ++changes;
    uint key = (now ? ENTERED : 0u) | (w.from - first + 1u);
    if (key <= done_key) return;
    ++left;
    if (best.key != 0u && key > best.key) return;
    best = Change(key, w.from, end, w.positive, w.negative, w.candidates);
}

// A side as a layer.
struct Layer {
    vec4 colour;
    vec3 n;    // unit, towards the eye
    uint id;
    vec2 uv;
    uint surface; // that contains it, or NO_SURFACE
};

Layer layer_of(uint side, float t, Ray ray) {
    Side s = side_at(side, t, ray);
    Leaf leaf = leaves[s.leaf];
    vec3 n = normalize(s.n);
    vec2 uv = vec2(uintBitsToFloat(0x7fc00000u));
    return Layer(unpackUnorm4x8(leaf.colour), dot(n, ray.d) > 0.0 ? -n : n, leaf.id, uv, s.surface);
}

Layer layer_of_patch(Fragment f, Ray ray) {
    uint patch_instance = seen_patch_instance(f.what);
    FaceInstance fi = face_instances[patch_instances[patch_instance]];
    Face face = faces[fi.face];
    View view = views[fi.instance];
    Patch patch_;
    vec3 n;
    uint number = patch_instance - fi.first_patch_instance;
    Sample s = surface_under(face, number, view, unpack_uv(f.uv), gl_FragCoord.xy, patch_, n);
    n = normalize(instances[fi.instance].normal * n);
    vec2 at = patch_.domain.xy + s.uv * patch_.domain.zw;
    vec4 colour = unpackUnorm4x8(face.colour);
    vec2 uv = face.domain.xy + at * face.domain.zw;
    return Layer(colour, dot(n, ray.d) > 0.0 ? -n : n, face.id, uv, NO_SURFACE);
}

float depth_written(float t) { return reversed_depth(frame, t) / (frame.perspective != 0u ? t : 1.0); }

bool packs_faces() { return FOLLOWED_FOR == FOR_NTH || FOLLOWED_FOR == FOR_BACK; }

void main() {
    uint n = tile_in_band(frame, uvec2(gl_FragCoord.xy));
    uint first = min(tile_starts[n], frame.tile_leaf_capacity);
    uint end = min(tile_starts[n + 1u], frame.tile_leaf_capacity);
    while (first < end && leaf_number(tile_leaf_at(tile_leaves, first)) < frame.followed_leaf) ++first;
    Ray ray = eye_ray(frame, gl_FragCoord.xy);
    uint pixel = pixel_in_band(frame, uvec2(gl_FragCoord.xy));
    uint first_fragment = SOLIDS_HAVE_BOUNDARY_OPERANDS ? fragment_starts[pixel] : 0u;
    uint fragment_count = SOLIDS_HAVE_BOUNDARY_OPERANDS ? fragment_counts[pixel] : 0u;
    vec4 under = FOLLOWED_FOR == FOR_THICKNESS ? vec4(0.0, 0.0, 0.0, UNSEEN) : imageLoad(behind, ivec2(gl_FragCoord.xy));
    bool mixed = under.a < 0.0;
    float stop = mixed ? UNSEEN : under.a;

    vec3 sum = vec3(0.0); // of layers
    float rest = 1.0;     // transparency of all layers so far
    float first_seen = stop;
    float thickness = 0.0;
    vec4 packed = vec4(0.0); // nothing
    uint faces_met = 0u;     // faces so far that may have lines
    bool touches = false;
    bool overlaps = false;
    bool shows = true;    // layers are still drawn

    Span kept[KEPT];
    uint purpose = SEARCH;
    uint asked = NOBODY;
    uint after = 0u;
    uint fallback = NOBODY;
    bool negatives = false;
    uint side = 0u;
    bool of_patch = false;
    float t = frame.near;
    float next = NEVER;
    uint done_key = 0u;
    uint left_then = 0u; // of the last search
    Change layer = Change(0u, 0u, 0u, NOBODY, NOBODY, 0u);
    uint all_from = first; // start of all items that are still ahead
    uint all_end = end;
    uint scan_from = first;
    uint scan_end = end;
    bool begins = true; // at the near plane no item is entered
    bool done = first >= end;
    uint most = 24u * (end - first) + 8u * fragment_count + 8u;
    uint wanted = 0u;
    uint steps = 0u;
    uint scan = 0u;
    for (; scan < most && !done; ++scan) {
        best = Change(0u, 0u, 0u, NOBODY, NOBODY, 0u);
        changes = 0u;
        left = 0u;
        within = 0u;
        live_from = end;
        live_end = first;
        Walk w = Walk(NOBODY, 0u, EXIT_FALSE, EXIT_FALSE, NOBODY, NOBODY, 0u, false);
        float soonest = NEVER;
        Run run = NO_RUN;
        Jumps jumps = Jumps(NOBODY, scan_from, scan_from);
        wanted += scan_end - scan_from;
        for (uint i = scan_from; i < scan_end; ++i) {
            ++steps;
            TileLeaf here = tile_leaf_at(tile_leaves, i);
            uint number = leaf_number(here);
            Leaf leaf = leaves[number];
            if (leaf.item != w.item) {
                close_item(w, i, first, done_key, purpose == SEARCH && !begins);
                w = Walk(leaf.item, i, EXIT_FALSE, EXIT_FALSE, NOBODY, NOBODY, 0u, false);
            }
            if ((here.leaf & TILE_LEAF_ENTRY) != 0u) {
                w.at = i;
                w.at_before = i;
            }
            bool is_kept = i - first < KEPT;
            bool operand = SOLIDS_HAVE_BOUNDARY_OPERANDS && (leaf.flags & LEAF_BOUNDARY) != 0u;
            Crossing c;
            Span part = NOTHING; // of the ray in the leaf, where it is one piece
            if (operand) {
                uint last;
                c = crossing_of(leaf.first, t, first_fragment, fragment_count, last);
                if (purpose == SIDE) {
                    of_patch = (fragment_at(fragments, last).operand & FRAGMENT_PATCH) != 0u;
                    side = of_patch ? last : fragment_at(fragments, last).what;
                }
            } else {
                Span s = EVERYTHING;
                float lo = -NEVER;
                float hi = NEVER;
                if (!is_kept && (leaf.flags & LEAF_UNBOUNDED) == 0u) {
                    float middle = dot(frame.forward, leaf_centres[number]);
                    float reach = dot(abs(frame.forward), leaf.half_size);
                    float rounding = BOX * (abs(middle) + reach);
                    lo = middle - reach - rounding;
                    hi = middle + reach + rounding;
                }
                if (t < lo || t > hi) {
                    // the ray is not near the box, or has passed it: as if the leaf began with its box
                    c = Crossing(false, false, false, t < lo ? lo : NEVER);
                    part = Span(c.next, NEVER, NEVER, NEVER);
                } else {
                    if (is_kept && scan > 0u && purpose != SIDE) {
                        s = kept[i - first];
                    } else {
                        uint ends = side;
                        s = leaf_span(here.of, ray.o, ray.d, t, ends);
                        if (purpose == SIDE) {
                            side = ends;
                            of_patch = false;
                        }
                        if (is_kept) kept[i - first] = s;
                    }
                    c = crossing_of(s, t);
                    part = s;
                }
            }
            bool led_to = is_led_to(jumps, i);
            bool joins = run.next == i && run.out_exit == here.out_exit && !led_to;
            if (!joins) {
                soonest = min(soonest, next_of_run(run, t));
                run = Run(-NEVER, NEVER, NOBODY, here.out_exit);
            }
            if (operand || part.g0 < part.g1) {
                soonest = min(soonest, min(c.next, next_of_run(run, t)));
                run = NO_RUN;
            } else {
                run.lo = max(run.lo, part.lo);
                run.hi = min(run.hi, part.hi);
                run.next = here.in_exit == i + 1u ? here.in_exit : NOBODY;
            }
            if (here.in_exit != i + 1u) add_jump(jumps, here.in_exit);
            if (here.out_exit != i + 1u) add_jump(jumps, here.out_exit);
            bool turned = purpose == OWNER && i == asked;
            if (i == w.at) w.at = c.inside != turned ? here.in_exit : here.out_exit;
            if (i == w.at_before) w.at_before = c.before != turned ? here.in_exit : here.out_exit;
            w.lives = w.lives || c.inside || c.ends || c.next < NEVER;
            if (c.ends && i >= after) {
                ++w.candidates;
                if ((leaf.flags & LEAF_NEGATIVE) != 0u) w.negative = min(w.negative, i);
                else w.positive = min(w.positive, i);
            }
        }
        close_item(w, scan_end, first, done_key, purpose == SEARCH && !begins);
        soonest = min(soonest, next_of_run(run, t));

        if (purpose == SEARCH) {
            begins = false;
            next = soonest;
            all_from = min(live_from, live_end);
            all_end = live_end;
            if (done_key == 0u) {
                float to = min(next, frame.far);
                if (within > 0u) thickness += to - t;
                touches = touches || changes > 1u;
                overlaps = overlaps || within > 1u;
            }
            layer = best;
            left_then = left;
            bool wants = shows && layer.key != 0u && FOLLOWED_FOR != FOR_THICKNESS;
            if (wants) {
                // an opaque face hides items entered at its depth, and everything behind it
                bool entered = (layer.key & ENTERED) != 0u;
                uint number = leaf_number(tile_leaf_at(tile_leaves, layer.from));
                float slack = (leaves[number].flags & LEAF_BOUNDARY) != 0u ? TOUCHES * abs(t) : 0.0;
                bool hidden = entered ? t + slack >= stop : t - slack > stop;
                if (hidden) {
                    shows = false;
                    wants = false;
                } else if ((leaves[number].flags & LEAF_ELSEWHERE) != 0u) {
                    done_key = layer.key;
                    if (left > 1u) continue;
                    wants = false;
                }
            }
            if (wants) {
                scan_from = layer.from;
                scan_end = layer.end;
                asked = layer.positive != NOBODY ? layer.positive : layer.negative;
                fallback = asked;
                after = asked + 1u;
                negatives = layer.positive == NOBODY;
                purpose = layer.candidates > 1u ? OWNER : SIDE;
                if (purpose == SIDE) {
                    scan_from = asked;
                    scan_end = asked + 1u;
                }
                continue;
            }
        } else if (purpose == OWNER) {
            // the owner is the first leaf that by itself changes the item, in front of the event or behind it
            bool entered = (layer.key & ENTERED) != 0u;
            uint other = negatives ? w.negative : w.positive;
            if ((w.at == EXIT_TRUE) != entered || (w.at_before == EXIT_TRUE) == entered) {
                purpose = SIDE;
            } else if (other != NOBODY) {
                asked = other;
                after = other + 1u;
            } else if (!negatives) {
                negatives = true;
                asked = NOBODY; // again from the first leaf, for subtracted leaves
                after = layer.from;
            } else {
                asked = fallback;
                purpose = SIDE;
            }
            if (purpose == SIDE) {
                scan_from = asked;
                scan_end = asked + 1u;
            }
            continue;
        } else {
            bool entered = (layer.key & ENTERED) != 0u;
            Layer seen;
            if (SOLIDS_HAVE_PATCHES && of_patch) seen = layer_of_patch(fragment_at(fragments, side), ray);
            else seen = layer_of(side, t, ray);
            float opacity = seen.colour.a;
            if (opacity > 0.0 && packs_faces()) {
                bool is_patch = SOLIDS_HAVE_PATCHES && of_patch;
                Fragment f = is_patch ? fragment_at(fragments, side) : Fragment(0u, 0.0, side, 0u);
                ++faces_met;
                bool is_asked = FOLLOWED_FOR == FOR_BACK || faces_met == nth;
                if (is_asked) packed = pack_layer((is_patch ? SEEN_OPERAND : SEEN_SOLID) | f.what, f.uv, t);
                shows = opacity < 1.0 && (FOLLOWED_FOR == FOR_BACK || faces_met < nth);
            } else if (opacity > 0.0) {
                if (first_seen == stop && rest == 1.0) first_seen = t;
                Lit lit = lit_at(seen.colour.rgb, seen.n, false, ray, t, seen.surface);
                if (FOLLOWED_FOR == FOR_FIRST) {
                    out_colour = vec4(0.0);
                    out_depth = t;
                    out_face = seen.id;
                    out_uv = seen.uv;
                    out_normal = vec4(entered ? seen.n : -seen.n, lit.sun);
                    gl_FragDepth = depth_written(t);
                    if (steps != wanted) atomicAdd(counters.clamps, 1u);
                    return;
                }
                sum += rest * opacity * clamp(lit.light, 0.0, 1.0);
                rest *= 1.0 - opacity;
                shows = rest > OPAQUE;
            }
            done_key = layer.key;
            purpose = SEARCH;
            after = 0u;
            scan_from = all_from;
            scan_end = all_end;
            // further items at the same depth
            if (shows && left_then > 1u) continue;
        }
        purpose = SEARCH;
        after = 0u;
        scan_from = all_from;
        scan_end = all_end;
        done_key = 0u;
        bool ends = FOLLOWED_FOR != FOR_THICKNESS && !MARKS && stop > 0.0;
        bool goes_on = FOLLOWED_FOR == FOR_THICKNESS || MARKS || shows;
        if (next >= frame.far || all_from >= all_end || !goes_on || ends && next > stop * (1.0 + TOUCHES)) done = true;
        t = next;
    }
    // count rays whose loops a driver ended
    if (steps != wanted || !done) atomicAdd(counters.clamps, 1u);
    if (FOLLOWED_FOR == FOR_FIRST) discard;
    if (packs_faces()) {
        out_colour = packed;
        return;
    }
    if (FOLLOWED_FOR == FOR_THICKNESS) {
        out_colour = vec4(thickness * length(ray.d));
        return;
    }
    if (MARKS) {
        // marks lie in front of everything
        if (touches) atomicAdd(counters.contacts, 1u);
        if (overlaps) atomicAdd(counters.overlaps, 1u);
        vec4 on_top[2] = vec4[](overlap, contact);
        bool on[2] = bool[](overlaps, touches);
        for (uint k = 0u; k < 2u; ++k) {
            if (!on[k]) continue;
            sum = mix(sum, on_top[k].rgb, on_top[k].a);
            rest *= 1.0 - on_top[k].a;
        }
    }
    float alpha = 1.0; // of the colours behind
    bool nothing = stop >= UNSEEN;
    if (mixed) {
        alpha = -under.a;
        under.rgb /= alpha;
    } else if (nothing) {
        alpha = max(frame.background.a, 0.0);
        under.rgb = frame.background.rgb;
    }
    float opacity = 1.0 - rest * (1.0 - alpha);
    if (opacity == 0.0 && frame.background.a < 0.0) discard;
    vec3 colour = opacity > 0.0 ? (sum + rest * alpha * under.rgb) / opacity : under.rgb;
    out_colour = encode(vec4(colour, opacity), frame.encode_srgb);
    // the host's picture shows through; samples are added up
    if (frame.background.a < 0.0 || frame.encode_srgb == ENCODE_SUMMED) out_colour.rgb *= opacity;
    gl_FragDepth = first_seen >= UNSEEN ? 0.0 : depth_written(first_seen);
}

#endif
