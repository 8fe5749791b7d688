// The point of the exact surface of a face under a pixel, with its normal where it has none of its own, too. Needs
// scene.glsl and refine.glsl; whoever includes this has `Patch patch_at(uint)`.
#ifndef PATCH_NORMAL_GLSL
#define PATCH_NORMAL_GLSL

#include "patch_place.glsl"

// Some surface is made of patches that do not go on as those beside them would: of several, and no plane, cylinder, cone,
// sphere or torus.
layout(constant_id = 19) const bool SCENE_HAS_PIECES = false;

const float FIRST_INWARDS = 1e-3; // of the way to the patch's middle
const float MOST_INWARDS = 0.3;

// Column and row of the patch of a face on which (u, v) of that at `place` lies: that itself, or the one beside it.
ivec2 place_beside(Face face, ivec2 place, vec2 uv) {
    ivec2 last = ivec2(face.count_u, face.count_v) - 1;
    place += way_beyond(uv, 0.0);
    ivec2 within = clamp(place, ivec2(0), last);
    ivec2 around = mix(mix(place, last, lessThan(place, ivec2(0))), ivec2(0), greaterThan(place, last));
    bvec2 closed = bvec2((face.flags & FACE_CLOSED_U) != 0u, (face.flags & FACE_CLOSED_V) != 0u);
    return mix(within, around, closed);
}

// What `refine` finds from (u, v) of patch `n` of the face, on whichever patch that is, `patch_`, and S_u x S_v there, or
// where it vanishes (pole, collapsed side) its limit from the patch's inside. A drawn patch may cover a pixel whose centre
// sees the one beside it, which need not go on as the drawn one would; between knots that are nearly one lie others, far
// narrower, and are passed over.
//
// One evaluation, in one loop: a rasterizer in software runs what no pixel asks for once, too. For fragments: their groups
// are the same in every frame, where those of compute shaders may not be (refine.glsl says what that does).
Sample surface_under(Face face, uint n, View view, vec2 uv, vec2 pixel, out Patch patch_, out vec3 normal) {
    // divided once: a division of integers costs a rasterizer in software as much as what is looked up
    ivec2 place = SCENE_HAS_PIECES ? place_of(face, int(n)) : ivec2(0);
    vec2 closed = vec2((face.flags & FACE_CLOSED_U) != 0u, (face.flags & FACE_CLOSED_V) != 0u);
    Patch own = patch_at(face.first_patch + n);
    Net net = net_of(own);
    Sample best;
    ivec2 drawn = place; // the best one's patch
    vec2 next = uv;
    vec2 at;        // the same of the whole face, where another patch is looked at
    bool hops = false;
    uint steps = 0u;
    float inwards = 0.0; // found: the normal is looked for
    bool found = false;
    while (!found) {
        bool nowhere = false;
        if (SCENE_HAS_PIECES) {
            own = patch_at(patch_in(face, place));
            nowhere = hops && side_of(own.shape) == SIDE_OUTSIDE; // all of it is trimmed away: it has no control points
            if (nowhere) own = patch_;
            net = net_of(own);
            if (hops) next = (at - own.domain.xy) / own.domain.zw;
        }
        Sample here = sample_at(own, net, view, next, pixel);
        Jet jet = here.jet;
        bool goes_on = false;
        if (inwards == 0.0) {
            bool passes = hops && !nowhere && place_beside(face, place, next) != place;
            bool nearer = steps == 0u || !passes && !nowhere && dot(here.miss, here.miss) < dot(best.miss, best.miss);
            if (nearer) {
                best = here;
                patch_ = own;
                drawn = place;
            }
            vec2 step_;
            bool farther = step_from(patch_, best, view, CLOSE_ENOUGH, step_);
            // on a plane no other evaluation is needed, unless the step leads out of it or falls short
            Sample there = along_plane(best, view, step_, pixel);
            bool arrives = clamp(there.uv, 0.0, 1.0) == there.uv && !misses(there, CLOSE_ENOUGH);
            if (farther && patch_.bend == vec3(0.0) && arrives) {
                best = there;
                step_ = vec2(0.0);
                farther = false;
            }
            // the rest of the way may lead across a side
            if (SCENE_HAS_PIECES && nearer) farther = farther || place_beside(face, place, best.uv - step_) != place;
            goes_on = (farther && nearer || passes) && steps < NEWTON_STEPS;
            ++steps;
            if (!passes) next = best.uv - step_;
            if (SCENE_HAS_PIECES) {
                ivec2 beside = place_beside(face, place, next);
                hops = goes_on && beside != place;
                at = own.domain.xy + next * own.domain.zw;
                at -= closed * floor(at);
                place = goes_on ? beside : drawn;
            }
            jet = best.jet;
        }
        if (!goes_on) {
            normal = cross(jet.du, jet.dv);
            float size = dot(best.jet.du, best.jet.du) + dot(best.jet.dv, best.jet.dv);
            inwards = inwards == 0.0 ? FIRST_INWARDS : 4.0 * inwards;
            found = dot(normal, normal) >= 1e-10 * size * size || inwards >= MOST_INWARDS;
            next = mix(best.uv, vec2(0.5), inwards);
        }
    }
    return best;
}

#endif
