// The point of a face's exact surface under a pixel, with a normal even at degenerate points. Needs scene.glsl,
// refine.glsl and `Patch patch_at(uint)`.
#ifndef PATCH_NORMAL_GLSL
#define PATCH_NORMAL_GLSL

#include "patch_place.glsl"

// Some face has several patches and is no plane, cylinder, cone, sphere or torus: its patches do not follow one
// equation.
layout(constant_id = 19) const bool SCENE_HAS_PIECES = false;

const float FIRST_INWARDS = 1e-3; // share of the way to the patch's middle
const float MOST_INWARDS = 0.3;

// Column and row of the face's patch that contains (u, v) of the patch at `place`: that patch, or the one beside it.
ivec2 place_beside(Face face, ivec2 place, vec2 uv) {
    ivec2 last = ivec2(face.count_u, face.count_v) - 1;
    place += way_beyond(uv, 0.0);
    ivec2 within = clamp(place, ivec2(0), last);
    ivec2 around = mix(mix(place, last, lessThan(place, ivec2(0))), ivec2(0), greaterThan(place, last));
    bvec2 closed = bvec2((face.flags & FACE_CLOSED_U) != 0u, (face.flags & FACE_CLOSED_V) != 0u);
    return mix(within, around, closed);
}

// The result of `refine` from (u, v) of patch `n` of the face, on the patch `patch_` where it ends. Also S_u x S_v
// there, or its limit from inside the patch where it vanishes (pole, collapsed side). A drawn patch may cover a pixel
// whose centre shows the next patch, which need not continue it; between nearly equal knots lie far narrower patches,
// which are skipped.
//
// One evaluation, in one loop: a software rasteriser runs every evaluation once, even if no pixel needs it. For
// fragment shaders: their groups are the same in every frame, unlike those of compute shaders (refine.glsl says why
// that matters).
Sample surface_under(Face face, uint n, View view, vec2 uv, vec2 pixel, out Patch patch_, out vec3 normal) {
    // divided once: on a software rasteriser an integer division costs as much as a look-up
    ivec2 place = SCENE_HAS_PIECES ? place_of(face, int(n)) : ivec2(0);
    vec2 closed = vec2((face.flags & FACE_CLOSED_U) != 0u, (face.flags & FACE_CLOSED_V) != 0u);
    Patch own = patch_at(face.first_patch + n);
    Net net = net_of(own);
    Sample best;
    ivec2 drawn = place; // the patch of the best one
    vec2 next = uv;
    vec2 at;        // the parameters in the whole face, for other patches
    bool hops = false;
    uint steps = 0u;
    float inwards = 0.0; // the point is found: the normal is searched
    bool found = false;
    while (!found) {
        bool nowhere = false;
        if (SCENE_HAS_PIECES) {
            own = patch_at(patch_in(face, place));
            nowhere = hops && side_of(own.shape) == SIDE_OUTSIDE; // trimmed away as a whole: it has no control points
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
            // on a plane no second evaluation is needed, unless the step leaves it or falls short
            Sample there = along_plane(best, view, step_, pixel);
            bool arrives = clamp(there.uv, 0.0, 1.0) == there.uv && !misses(there, CLOSE_ENOUGH);
            if (farther && patch_.bend == vec3(0.0) && arrives) {
                best = there;
                step_ = vec2(0.0);
                farther = false;
            }
            // the rest of the way may cross a side
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
