// The candidates of a gap candidate's neighbourhood. Needs gap_surface.glsl and gap_decide.glsl.
//
//        ┌───┬───┬───┐     the faces of the eight neighbours, each by its exact surface at this pixel's centre.
//        │ A │ A │ B │     Other gap candidates do not count, except those of open shells. Where a front and a back
//        ├───┼───┼───┤     nearly touch, gap candidates form a band: then the first pixel beyond it counts, in each
//        │ A │ ? │ B │     of the eight directions
//        └───┴───┴───┘
#ifndef GAP_GATHER_GLSL
#define GAP_GATHER_GLSL

#include "in_picture.glsl"

// Distance to which neighbours are searched; WIDE_BAND_PX for an eye within a face's solid.
const uint BAND_PX = 4u;
// Distance across a fold, in widths of the patch.
const float ACROSS = 0.2;

// Whether a neighbour's surface counts. On an open shell, the mark of a gap candidate means a border before it; the
// surface itself is there as drawn.
bool counts(uint word) {
    if ((word & GAP_CANDIDATE) == 0u) return true;
    if (sees_nothing(word)) return false;
    return (face_at(face_instance_at(face_instance_of(seen_patch_instance(word))).face).flags & FACE_SOLID) == 0u;
}

// Whether at least three in four pixels around this one show the back of a solid's face: then the eye is within the
// solid.
bool among_backs(ivec2 at) {
    int more = 0;
    for (uint k = 0u; k < DIRECTION_COUNT; ++k) {
        ivec2 step_ = ivec2(sign(DIRECTIONS[k]));
        ivec2 beside = at;
        for (uint steps = 0u; steps < WIDE_BAND_PX; ++steps) {
            beside += step_;
            if (!is_in_picture(beside)) break;
            more += counts(imageLoad(visibility, beside).x) ? -3 : 1;
        }
    }
    return more > 0;
}

// Depth of the mesh or solid that a pixel shows.
float other_depth(uvec2 seen, vec2 pixel) {
    if (!sees_mesh(seen.x)) return uintBitsToFloat(seen.y);
    return facet_at(seen.y, view_at(mesh_instances[seen_mesh_instance(seen.x)].instance), pixel).depth;
}

// The situation without the own face and the neighbours.
Situation situation_at(uint listed, ivec2 at, vec2 pixel, bool within) {
    uvec2 seen = imageLoad(visibility, at).xy;
    uvec2 other = SCENE_HAS_MESHES_OR_SOLIDS ? imageLoad(meshes_and_solids, at).xy : uvec2(0u);
    Situation s;
    s.border = (listed & BORDER_BEFORE) != 0u || within;
    s.isolated = (listed & BORDER_BEFORE) != 0u && (listed & ISOLATED) != 0u;
    s.empty = sees_nothing(seen.x);
    s.empty_beside = false;
    s.other_beside = false;
    s.other = other.x != 0u;
    s.other_depth = s.other ? other_depth(other, pixel) : 3.0e38;
    s.own = no_candidate();
    s.seen = seen;
#ifdef WITHIN_VOLUME
    s.cut_open = true;
#else
    s.cut_open = false;
#endif
    s.in_solid = within;
    return s;
}

// The first pixel that counts, `step_` by `step_`; returns the number of steps, 0 if there is none.
uint first_that_counts(ivec2 at, ivec2 step_, uint band, bool within, out ivec2 beside, out uvec2 seen) {
    beside = at;
    seen = uvec2(0u);
    uint found = 0u;
    for (uint steps = 1u; steps <= band && found == 0u; ++steps) {
        beside += step_;
        if (!is_in_picture(beside)) break;
        seen = imageLoad(visibility, beside).xy;
        if (within || counts(seen.x)) found = steps;
    }
    return found;
}

// The arguments of a call of `candidate_at`, and whether there is one.
struct Question {
    bool asked;
    uvec2 seen;
    uint from;
    uint radius;
};

Question ask_own(Situation s) {
    uint radius = s.border ? RADIUS_OF_INSIDE | RADIUS_OF_OUTSIDE : RADIUS_OF_INSIDE;
    return Question(!s.empty, s.seen, FROM_BESIDE, radius);
}

// A curved face may show its front at the same pixel, across the fold, if the front is narrower than the tessellation's
// error.
Question ask_across_fold(Situation s, vec2 direction) {
    uvec2 seen = uvec2(s.seen.x, pack_uv(unpack_uv(s.seen.y) + ACROSS * direction));
    return Question(true, seen, FROM_FOLD, RADIUS_OF_OUTSIDE);
}

// A neighbour; if it shows no patch, adds to the situation.
Question ask_beside(inout Situation s, ivec2 at, ivec2 step_, bool within) {
    ivec2 beside;
    uvec2 seen;
    uint band = is_interior(s) ? WIDE_BAND_PX : BAND_PX;
    uint steps = first_that_counts(at, step_, band, within, beside, seen);
    bool nothing = steps == 1u && sees_nothing(seen.x);
    uvec2 there = nothing && SCENE_HAS_MESHES_OR_SOLIDS ? imageLoad(meshes_and_solids, beside).xy : uvec2(0u);
    if (nothing && there.x == 0u) s.empty_beside = true;
    if (nothing && there.x != 0u) s.other_beside = true;
    return Question(steps != 0u && !sees_nothing(seen.x), seen, steps > 1u ? FROM_BEYOND : FROM_BESIDE, RADIUS_OF_OUTSIDE);
}

// Collects all candidates, the own face first, and the neighbours without patches. `within`: the eye is within a solid,
// so the solid's faces show their backs and count although marked. One call of `candidate_at`, which drivers inline:
//
//     n   0     1 … 8             9 … 16
//         own   across its fold   the neighbours
Evidence gather(inout Situation s, ivec2 at, vec2 pixel, bool within) {
    Evidence e = no_evidence(s);
    uint n = 0u;
    while (n <= 2u * DIRECTION_COUNT) {
        Question q = ask_own(s);
        if (n > 0u) q = ask_across_fold(s, DIRECTIONS[(n - 1u) % DIRECTION_COUNT]);
        if (n > DIRECTION_COUNT) q = ask_beside(s, at, ivec2(sign(DIRECTIONS[(n - 1u) % DIRECTION_COUNT])), within);
        if (q.asked) {
            Candidate c = candidate_at(q.seen, pixel, q.from, q.radius);
            if (n == 0u) s.own = c;
            else consider(e, s, c);
        }
        n += n == 0u && s.border ? DIRECTION_COUNT + 1u : 1u; // a border has no fold
    }
    return e;
}

#endif
