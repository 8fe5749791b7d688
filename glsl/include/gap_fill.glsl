// Pass `heal`, second step: who is seen at a doubtful pixel? One thread a pixel. The trim test is that of one
// way (trim.glsl).
//
//        ┌───┬───┬───┐     the faces of the eight neighbours are asked, on their exact surfaces at
//        │ A │ A │ B │     this pixel's centre:
//        ├───┼───┼───┤       inside its trims?           then it is a witness
//        │ A │ ? │ B │       within the ring of them?    then it is a helper
//        ├───┼───┼───┤
//        │   │   │ B │     The doubtful face itself is `real` when its own surface is inside its trims,
//        └───┴───┴───┘     and the whole ring too: farther from its border than any error.
//
//   its own front, across a fold, is a witness too; so is what is no patch behind the pixel, where an
//   end of the patches is near: a neighbour sees nothing or such a thing behind the doubtful face, or there is a witness
//   a face from behind, real (a gap looks into the solid):
//                                  the nearest witness or helper before it, else a front that touches it, else
//                                  whichever neighbour's surface passes before or beside the pixel's centre, one
//                                  before it if possible
//   a face from behind, not real (its fold is near, or its border by a rounding):
//     helpers of two faces before every witness    the nearest: an edge runs here
//     a witness                                    the nearest: behind a silhouette
//     a neighbour that sees nothing                nothing
//     a helper                                     the nearest
//     what is no patch behind the pixel            nothing, so that it is seen
//   a ring before what is seen, which is asked like a neighbour:
//     helpers of two faces before every witness    the nearest: an edge runs here
//     who covers the face itself                   the nearest: both end here in a silhouette
//     a witness                                    the nearest: behind a silhouette, or no border at all; not the
//                                                  face itself where it ends and two others meet, as near as they lean
//     the face itself, which has grown to here     it stays, before witnesses and behind no helper, in all of the ring.
//                                                  Where nobody else is, a neighbour's solid face helps that bends away
//                                                  between the two pixels: it hides what ends in its silhouette
//     nothing is seen                              nothing
//     a helper                                     the nearest
//   a ring before what is seen, or before a face from behind, among such faces: as a ring above. The eye is within a
//   solid, so what is seen of it is from behind, and asked though it is doubtful
//   nothing, between patches on both sides:
//     a witness                                    the nearest: silhouettes meet, drawn inside of what they are
//   and where a volume cuts the scene open (WITHIN_VOLUME), before a face from behind:
//     helpers of one face                          the nearest: the outline of the part runs here
//
// Of helpers of two faces the farther one counts as the nearest where it covers the nearer one: see `covers`.
//
// Without any of these what was seen stays. Who is seen is written into the list, and shown by the next step (healed.comp),
// so neighbours tell what was drawn and the order of the threads does not matter. Doubtful ones are not asked, but for
// open shells' (`tells`). Where a front and a back nearly touch, doubtful pixels fill a band: then the first pixel beyond
// it is asked, in each of the eight directions, and heard only as a witness that looks at the viewer.
#include "scene.glsl"
#include "view.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 7, rg32ui) readonly uniform uimage2D visibility;
layout(scalar, binding = 8) buffer Doubts { Doubt doubts[]; };
layout(scalar, binding = 9) readonly buffer CountersBuffer { Counters counters; };
layout(binding = 11, rg32ui) readonly uniform uimage2D others;
layout(scalar, binding = 12) readonly buffer MeshInstances { MeshInstance mesh_instances[]; };
layout(scalar, binding = 13) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 14) readonly buffer Positions { vec3 positions[]; };

#define TRIM_BINDING 15
#include "trim.glsl"
#ifdef WITHIN_VOLUME
#define VOLUME_BINDING (TRIM_BINDING + TRIM_BUFFERS)
#include "volume.glsl"
#endif
#include "facet.glsl"
#include "facing.glsl"
#define INSTANCES_BINDING 10
#include "placed.glsl"
#include "patch.glsl"
#include "patch_place.glsl"
#include "refine.glsl"
#include "ring.glsl"
#include "visible.glsl"

// Who is asked for the ring around the point: those that are inside their trims there, whether all of it is; those that
// are not, whether some of it is.
const uint RING_INSIDE = 1u;
const uint RING_OUTSIDE = 2u;

const uint NO = 0u;
const uint HELPER = 1u;
const uint WITNESS = 2u;

// A surface counts at the pixel when its point projects this close to the centre.
const float ON_PIXEL_PX = 0.05;
// Relative depth within which a face touches the doubtful one, and is as hidden as that.
const float SAME_DEPTH = 1e-6;

// How far away a neighbour is looked for; WIDE_BAND_PX from within a face from behind.
const uint BAND_PX = 4u;

// How many patches of its face a neighbour's answer may lead across: a patch may be smaller than a pixel.
const uint MAX_HOPS = 8u;
// Of a patch's width: less beyond its side is rounding, and the side's own point.
const float BEYOND = 1e-4;
// The same for the end of a face without trims: single precision, and what Newton's method leaves of 100 pixels.
const float ROUNDED = 1e-5;

// How far across a fold, in widths of the patch.
const float ACROSS = 0.2;

struct Answer {
    uint kind;
    bool inside; // its trims, there
    float depth;
    float miss; // pixels
    bool away;  // looks away from the viewer
    vec2 slope; // of its depth, a pixel
    uvec2 word;
};

// How much its depth changes within the ring.
float lean(Answer answer) { return RING_SLACK * frame.ring_px * length(answer.slope); }

// In all of the ring: surfaces that meet in it are not.
bool wholly_before(Answer a, Answer b) { return a.depth + lean(a) + lean(b) < b.depth; }

// Whether (u, v) of a patch that no loop cuts is in it, or in one beside it that the loops leave. A surface
// goes on beyond its own end, but the face does not.
bool in_whole_patch(FaceInstance fi, Face face, uint item, vec2 uv) {
    ivec2 count = ivec2(face.count_u, face.count_v);
    ivec2 place = place_of(face, int(item - fi.first_item)) + way_beyond(uv, ROUNDED);
    if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, count))) return false;
    return side_of(patch_at(patch_in(face, place)).shape) != SIDE_OUTSIDE;
}

// Whether the face is there at (u, v) of the item's patch. The table has rows only where its border runs: not
// for strips and bays in which all patches are whole.
bool is_there(FaceInstance fi, Face face, uint item, Patch patch_, vec2 uv) {
    if ((face.flags & FACE_TRIMMED) == 0u) return in_whole_patch(fi, face, item, uv);
    vec2 at = patch_.domain.xy + uv * patch_.domain.zw;
#ifdef TRIM_BY_TABLE
    if (side_of(patch_.shape) == SIDE_INSIDE) {
        if (clamp(uv, 0.0, 1.0) == uv) return true;
        if (!table_covers(fi.first_bay, face.strips, at)) return in_whole_patch(fi, face, item, uv);
    }
#endif
    return trim_inside(fi, face, at);
}

// `refine` from one patch of a face into the next where the point lies beyond a side. `item` becomes the
// one in which it ended.
Sample refine_across(FaceInstance fi, Face face, View view, inout uint item, vec2 uv, vec2 pixel) {
    ivec2 count = ivec2(face.count_u, face.count_v);
    Sample s = refine(patch_at(face.first_patch + item - fi.first_item), view, uv, pixel);
    for (uint hop = 0u; hop < MAX_HOPS; ++hop) {
        int n = int(item - fi.first_item);
        ivec2 place = place_of(face, n);
        ivec2 next = clamp(place + way_beyond(s.uv, BEYOND), ivec2(0), count - 1);
        if (next == place) break;
        Patch there = patch_at(patch_in(face, next));
        if (side_of(there.shape) == SIDE_OUTSIDE) break; // it has no control points
        Patch here = patch_at(face.first_patch + uint(n));
        vec2 from = (here.domain.xy + s.uv * here.domain.zw - there.domain.xy) / there.domain.zw;
        Sample t = refine(there, view, clamp(from, 0.0, 1.0), pixel);
        // beside a silhouette it may not come as near: then the first patch's continuation is better
        bool on = length(t.miss) <= max(length(s.miss), ON_PIXEL_PX);
        if (on) {
            item = fi.first_item + patch_in(face, next) - face.first_patch;
            s = t;
        }
        if (!on) break; // only now: see refine.glsl
    }
    return s;
}

// A face that bends away from the viewer between the pixel and `beside`, which sees it: whether it is there within the ring
// towards that one. At the pixel itself its surface looks away, where its trims tell nothing.
Answer ask_towards(vec2 beside, uvec2 seen, vec2 pixel, Answer behind) {
    uint item = seen_item(seen.x);
    FaceInstance fi = face_instance_at(face_instance_of(item));
    Face face = face_at(fi.face);
    View view = view_at(fi.instance);
    vec2 at = pixel + frame.ring_px * normalize(beside - pixel);
    Sample s = refine_across(fi, face, view, item, unpack_uv(seen.y), at);
    mat2 along = pixels_along(s, view);
    bool away = looks_away(determinant(along), face, instance_at(fi.instance));
    bool there = is_there(fi, face, item, patch_at(face.first_patch + item - fi.first_item), s.uv);
    bool helps = there && !away && length(s.miss) <= ON_PIXEL_PX && s.q.z <= behind.depth;
#ifdef WITHIN_VOLUME
    helps = helps && in_volume(s.q, ON_PX);
#endif
    uvec2 word = uvec2(item + 1u, pack_uv(clamp(s.uv, vec2(-1.0), vec2(2.0))));
    return Answer(helps ? HELPER : NO, false, s.q.z, frame.ring_px, away, vec2(0.0), word);
}

// How far apart in depth a front and a back count as one: the front stands back by this (visibility_trimmed.glsl).
float touch(Answer front) {
    float px = (frame.perspective != 0u ? front.depth : 1.0) / frame.focal;
    return 2.0 * frame.deviation_px * (abs(front.slope.x) + abs(front.slope.y) + px) + 2.0 * SAME_DEPTH * front.depth;
}

// Whether a neighbour is asked. A mark on what an open shell shows is that of a ring before it: as it is drawn, it is
// there.
bool tells(uint word) {
    if ((word & DOUBTFUL) == 0u) return true;
    if (sees_nothing(word)) return false;
    return (face_at(face_instance_at(face_instance_of(seen_item(word))).face).flags & FACE_SOLID) == 0u;
}

// Whether at least three in four of those around the pixel see a solid's face from behind: then the eye is within it.
bool among_backs(ivec2 at) {
    int more = 0;
    for (uint k = 0u; k < RING_POINTS; ++k) {
        ivec2 step_ = ivec2(sign(RING[k]));
        ivec2 beside = at;
        for (uint steps = 0u; steps < WIDE_BAND_PX; ++steps) {
            beside += step_;
            if (any(lessThan(beside, ivec2(0))) || any(greaterThanEqual(beside, ivec2(frame.size)))) break;
            more += tells(imageLoad(visibility, beside).x) ? -3 : 1;
        }
    }
    return more > 0;
}

// Who is not inside its trims helps only where it is before `behind`.
Answer ask(uvec2 seen, vec2 pixel, uint ring, Answer behind) {
    uint item = seen_item(seen.x);
    FaceInstance fi = face_instance_at(face_instance_of(item));
    Face face = face_at(fi.face);
    View view = view_at(fi.instance);
    Sample s = refine_across(fi, face, view, item, unpack_uv(seen.y), pixel);
    Patch patch_ = patch_at(face.first_patch + item - fi.first_item);
    uvec2 word = uvec2(item + 1u, pack_uv(clamp(s.uv, vec2(-1.0), vec2(2.0))));
    Answer answer = Answer(NO, false, s.q.z, length(s.miss), true, vec2(0.0), word);
#ifdef WITHIN_VOLUME
    if (!in_volume(s.q, RING_SLACK * frame.ring_px)) return answer;
    bool inside = in_volume(s.q, ON_PX) && is_there(fi, face, item, patch_, s.uv);
#else
    bool inside = is_there(fi, face, item, patch_, s.uv);
#endif
    answer.inside = inside;
    if (answer.miss > ON_PIXEL_PX) {
        // a silhouette beside the pixel
        if (inside && answer.miss <= RING_SLACK * frame.ring_px) answer.kind = HELPER;
        return answer;
    }
    mat2 along = pixels_along(s, view);
    vec2 pu = along[0];
    vec2 pv = along[1];
    float det = pu.x * pv.y - pu.y * pv.x;
    answer.away = looks_away(det, face, instance_at(fi.instance));
    if (inside) answer.kind = WITNESS;
    if (abs(det) < 1e-12) return answer;
    float zu = row_times(view.depth, vec4(s.jet.du, 0.0));
    float zv = row_times(view.depth, vec4(s.jet.dv, 0.0));
    answer.slope = vec2(zu * pv.y - zv * pu.y, zv * pu.x - zu * pv.x) / det;
    if ((ring & (inside ? RING_INSIDE : RING_OUTSIDE)) == 0u) return answer;
    for (uint k = 0u; k < RING_POINTS; ++k) {
        vec2 step_ = frame.ring_px * RING[k];
        vec2 duv = vec2(step_.x * pv.y - step_.y * pv.x, pu.x * step_.y - pu.y * step_.x) / det;
        bool there = is_there(fi, face, item, patch_, s.uv + duv);
        if (inside && !there) {
            answer.kind = HELPER;
            break;
        }
        if (inside || !there) continue;
        vec4 q = to_pixel(view, vec4(patch_jet(patch_.first, patch_.shape, s.uv + duv).point, 1.0));
#ifdef WITHIN_VOLUME
        // each alone may reach to the pixel from beside the corner in which they meet
        if (!in_volume(q, ON_PX)) continue;
#endif
        vec2 off = q.xy / q.w - pixel;
        if (q.z <= behind.depth + dot(behind.slope, off) && length(off) <= RING_SLACK * frame.ring_px) {
            answer.kind = HELPER;
            break;
        }
    }
    return answer;
}

// Into the face from its border near the pixel, pixels: the sum of the ring's points in it; zero where all are. `ends`:
// the other way the face does not reach half of the ring.
vec2 inwards(Answer answer, vec2 pixel, out bool ends) {
    uint item = seen_item(answer.word.x);
    FaceInstance fi = face_instance_at(face_instance_of(item));
    Face face = face_at(fi.face);
    Patch patch_ = patch_at(face.first_patch + item - fi.first_item);
    View view = view_at(fi.instance);
    Sample s = sample_at(patch_, net_of(patch_), view, unpack_uv(answer.word.y), pixel);
    mat2 uv_along = inverse(pixels_along(s, view));
    // a word's (u, v) has 16 bits, which in a large patch are a part of a pixel
    vec2 at = s.uv - uv_along * s.miss;
    vec2 sum = vec2(0.0);
    for (uint k = 0u; k < RING_POINTS; ++k) {
        vec2 step_ = frame.ring_px * RING[k];
        if (is_there(fi, face, item, patch_, at + uv_along * step_)) sum += step_;
    }
    vec2 out_ = -0.5 * frame.ring_px / max(length(sum), 1e-6) * sum;
    ends = !is_there(fi, face, item, patch_, at + uv_along * out_);
    return sum;
}

// Whether `a` hides `b` up to a silhouette in which both end here:
//
//     nearer     a ──.__         __.·· b continued      to the left of the edge, where both are, a is seen;
//                       `──.__.·´                       to the right neither is, but rounding may leave b there,
//                        __.─´`·.__                     or both continued, of which b is nearer
//     farther    b ──.─´           `·· a continued
//
// Who ends in an edge that is no silhouette lies on the other side of it, and who goes on beyond it is seen there. `a` is
// there within the ring, before `b`: to show it is off by no more than that.
bool covers(Answer a, Answer b, vec2 pixel) {
    if (max(a.miss, b.miss) > ON_PIXEL_PX) return false; // a surface's own silhouette
    bool a_ends, b_ends;
    vec2 into = inwards(a, pixel, a_ends);
    bool together = dot(into, inwards(b, pixel, b_ends)) > 0.0 && a_ends && b_ends;
    return together && a.depth - b.depth + dot(a.slope - b.slope, into) < 0.0;
}

// Of what is no patch, seen at a pixel.
float other_depth(uvec2 seen, vec2 pixel) {
    if (!sees_mesh(seen.x)) return uintBitsToFloat(seen.y);
    return facet_at(seen.y, view_at(mesh_instances[seen_mesh_instance(seen.x)].instance), pixel).depth;
}

void main() {
    uint n = gl_GlobalInvocationID.x;
    if (n >= min(counters.doubts, frame.doubt_capacity)) return;
    uint doubt = doubts[n].pixel;
    bool ringed = (doubt & RINGED) != 0u;
    ivec2 at = doubtful_pixel(doubt);
    // the eye is within a solid
    bool within = (ringed || (doubt & BEHIND_RING) != 0u) && among_backs(at);
    bool lone = ringed && (doubt & LONE) != 0u;
    ringed = ringed || within;
    vec2 pixel = vec2(at) + 0.5;
    uvec2 own = imageLoad(visibility, at).xy;
    uvec2 other = SCENE_HAS_OTHERS ? imageLoad(others, at).xy : uvec2(0u);
    bool nothing = sees_nothing(own.x);
    Answer none = Answer(NO, false, 3.0e38, 3.0e38, false, vec2(0.0), uvec2(0u));
    Answer self = none;
    uint own_face = nothing ? 0u : face_instance_at(face_instance_of(seen_item(own.x))).face + 1u;
    if (!nothing) self = ask(own, pixel, ringed ? RING_INSIDE | RING_OUTSIDE : RING_INSIDE, none);
    bool on = self.kind != NO && self.miss <= ON_PIXEL_PX;
    bool there = on && self.inside;
    bool real = !ringed && self.kind == WITNESS;
    float limit = real ? self.depth * (1.0 - SAME_DEPTH) : 3.0e38;
    Answer witness = none;
    Answer helper = none;
    Answer closest = none;
    bool closest_before = false;
    Answer touching = none; // a front where the doubtful back is
    Answer second = none; // helper, of another face
    uint helping_face = 0u; // index + 1, of the helper; helpers of two faces meet in an edge here
    bool two_help = false;
    uint meeting_face = 0u; // index + 1; two faces that meet the doubtful one here, where it ends
    bool two_meet = false;
    uvec2 bending = uvec2(0u); // a neighbour sees it, and it looks away at the pixel
    vec2 bending_at = pixel + 1.0;
    if (ringed && nothing && other.x != 0u) {
        witness = Answer(WITNESS, true, other_depth(other, pixel), 0.0, false, vec2(0.0), uvec2(0u));
    }
    // a curved face can show its front at the same pixel, narrower than the tessellation's error:
    // look for it across the fold
    for (uint k = 0u; k < RING_POINTS && !ringed; ++k) {
        uvec2 seen = uvec2(own.x, pack_uv(unpack_uv(own.y) + ACROSS * RING[k]));
        Answer answer = ask(seen, pixel, RING_OUTSIDE, none);
        bool front = answer.kind == WITNESS && !answer.away && answer.depth < limit;
        if (front && answer.depth < witness.depth) witness = answer;
    }
    Answer behind = none;
    if (ringed && there) behind = self; // a border that it hides is none
    uint band = real ? WIDE_BAND_PX : BAND_PX;
    bool beside_nothing = false;
    bool beside_behind = false; // something else that is behind the doubtful face
    for (uint k = 0u; k < RING_POINTS; ++k) {
        // where fronts and backs touch, doubtful pixels fill a band: look across it
        ivec2 step_ = ivec2(sign(RING[k]));
        ivec2 beside = at;
        uvec2 seen = uvec2(0u);
        uint steps = 0u;
        bool heard = false;
        while (steps < band && !heard) {
            ++steps;
            beside += step_;
            if (any(lessThan(beside, ivec2(0))) || any(greaterThanEqual(beside, ivec2(frame.size)))) break;
            seen = imageLoad(visibility, beside).xy;
            heard = within || tells(seen.x);
        }
        if (!heard) continue;
        if (sees_nothing(seen.x)) {
            if (steps > 1u) continue;
            uvec2 there = SCENE_HAS_OTHERS ? imageLoad(others, beside).xy : uvec2(0u);
            // one that stands before the doubtful face may hide its neighbour: it tells nothing
            if (there.x == 0u) beside_nothing = true;
            else if (other_depth(there, vec2(beside) + 0.5) > self.depth) beside_behind = true;
            continue;
        }
        Answer answer = ask(seen, pixel, RING_OUTSIDE, behind);
        if (steps == 1u && answer.kind == NO && answer.away) {
            bending = seen;
            bending_at = vec2(beside) + 0.5;
        }
        // who is farther away must be there, and look here: its border tells nothing
        if (steps > 1u && (answer.kind != WITNESS || answer.away)) continue;
        bool before = answer.depth <= limit;
        bool hidden = !before && answer.miss <= ON_PIXEL_PX; // by the doubtful face
        if (!hidden && (before && !closest_before || before == closest_before && answer.miss < closest.miss)) {
            closest = answer;
            closest_before = before;
        }
        bool touches = answer.kind == WITNESS && !answer.away && abs(answer.depth - self.depth) <= touch(answer);
        if (touches && answer.depth < touching.depth) touching = answer;
        if (!before) continue;
        uint face = face_instance_at(face_instance_of(seen_item(seen.x))).face + 1u;
        if (answer.kind == WITNESS && answer.depth < witness.depth) witness = answer;
        if (answer.kind == HELPER) {
            two_help = two_help || (helping_face != 0u && helping_face != face);
            bool another = face != helping_face;
            if (answer.depth < helper.depth) {
                if (another) second = helper;
                helper = answer;
                helping_face = face;
            } else if (another && answer.depth < second.depth) {
                second = answer;
            }
        }
        if (answer.kind != NO && face != own_face && answer.depth - lean(answer) - lean(self) <= self.depth) {
            two_meet = two_meet || (meeting_face != 0u && meeting_face != face);
            meeting_face = face;
        }
    }
    // where nobody else is
    if (ringed && !nothing && bending.x != 0u && witness.kind == NO && helper.kind == NO) {
        helper = ask_towards(bending_at, bending, pixel, behind);
    }
    // beyond their silhouette the one that it hides goes on before the other
    if (second.kind == HELPER && !wholly_before(helper, second) && covers(second, helper, pixel)) helper = second;
    // its border tells nothing: the face may be hidden but for that. Unless it ends here, where two others meet: it may
    // be the third, which they hide
    bool stays = false; // it has grown to the pixel, and is what is there
    bool helped = helper.kind == HELPER && helper.depth < witness.depth;
    Answer nearest = witness;
    if (helped) nearest = helper;
    bool covered = false; // by the nearest, up to a silhouette in which both end here
    if (ringed && on && self.kind == HELPER && nearest.kind != NO) {
        bool other_face = face_instance_at(face_instance_of(seen_item(nearest.word.x))).face + 1u != own_face;
        covered = other_face && covers(nearest, self, pixel);
    }
    if (ringed && on && !covered && self.depth < witness.depth && !(self.kind == HELPER && two_meet)) {
        stays = !self.inside && wholly_before(self, witness) && !wholly_before(helper, self);
        if (self.inside || stays) {
            witness = self;
            witness.kind = WITNESS;
        }
    }
    // where an end of the patches is near, what is no patch behind them is known at the very pixel
    if (!ringed && !real && other.x != 0u && (beside_nothing || beside_behind || witness.kind == WITNESS)) {
        float depth = other_depth(other, pixel);
        if (depth < witness.depth) witness = Answer(WITNESS, true, depth, 0.0, false, vec2(0.0), uvec2(0u));
    }
    uvec2 healed = own;
    bool has_witness = witness.kind == WITNESS;
    bool has_helper = helper.kind == HELPER;
    bool edge = covered && helped || two_help && helper.depth < witness.depth && !stays && !lone;
#ifdef WITHIN_VOLUME
    // the inside of what the volume cuts open, and before it the border of one face: the part's outline
    if (ringed && there && self.away) edge = edge || has_helper && helper.depth < self.depth;
#endif
    if (real) {
        if (has_witness && !(has_helper && helper.depth < witness.depth)) healed = witness.word;
        else if (has_helper) healed = helper.word;
        else if (touching.kind == WITNESS) healed = touching.word;
        else if (closest.miss <= RING_SLACK * frame.ring_px) healed = closest.word;
    } else if (edge) {
        healed = helper.word;
    } else if (has_witness) {
        healed = witness.word;
    } else if (ringed ? nothing : beside_nothing) {
        healed = uvec2(0u);
    } else if (has_helper) {
        healed = helper.word;
    } else if (!ringed && other.x != 0u) {
        healed = uvec2(0u);
    }
    doubts[n].healed = healed;
}
