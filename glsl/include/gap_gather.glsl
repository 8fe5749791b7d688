// The candidates of a gap candidate's neighbourhood. Needs gap_surface.glsl and gap_decide.glsl.
//
//        ┌───┬───┬───┐     the faces of the eight neighbours, each by its exact surface at this pixel's centre.
//        │ A │ A │ B │     Other gap candidates do not count, but for open shells'. Where a front and a back nearly
//        ├───┼───┼───┤     touch, they fill a band: then the first pixel beyond it counts, in each of the eight
//        │ A │ ? │ B │     directions
//        └───┴───┴───┘
#ifndef GAP_GATHER_GLSL
#define GAP_GATHER_GLSL

// How far away a neighbour is looked for; WIDE_BAND_PX from within a face from behind.
const uint BAND_PX = 4u;
// How far across a fold, in widths of the patch.
const float ACROSS = 0.2;

// Whether what a neighbour shows counts. The mark of a gap candidate on an open shell is that of a border before it: as it
// is drawn, it is there.
bool counts(uint word) {
    if ((word & GAP_CANDIDATE) == 0u) return true;
    if (sees_nothing(word)) return false;
    return (face_at(face_instance_at(face_instance_of(seen_item(word))).face).flags & FACE_SOLID) == 0u;
}

bool in_picture(ivec2 at) { return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(frame.size))); }

// Whether at least three in four pixels around this one see a solid's face from behind: then the eye is within it.
bool among_backs(ivec2 at) {
    int more = 0;
    for (uint k = 0u; k < DIRECTION_COUNT; ++k) {
        ivec2 step_ = ivec2(sign(DIRECTIONS[k]));
        ivec2 beside = at;
        for (uint steps = 0u; steps < WIDE_BAND_PX; ++steps) {
            beside += step_;
            if (!in_picture(beside)) break;
            more += counts(imageLoad(visibility, beside).x) ? -3 : 1;
        }
    }
    return more > 0;
}

// Depth of a mesh or solid that is seen at a pixel.
float other_depth(uvec2 seen, vec2 pixel) {
    if (!sees_mesh(seen.x)) return uintBitsToFloat(seen.y);
    return facet_at(seen.y, view_at(mesh_instances[seen_mesh_instance(seen.x)].instance), pixel).depth;
}

// The situation but for the own face and what the neighbours show.
Situation situation_at(uint listed, ivec2 at, vec2 pixel, bool within) {
    uvec2 seen = imageLoad(visibility, at).xy;
    uvec2 other = SCENE_HAS_MESHES_OR_SOLIDS ? imageLoad(others, at).xy : uvec2(0u);
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
    return s;
}

// The first pixel that counts, `step_` by `step_`; returns how many steps away, 0 without one.
uint first_that_counts(ivec2 at, ivec2 step_, uint band, bool within, out ivec2 beside, out uvec2 seen) {
    beside = at;
    seen = uvec2(0u);
    uint found = 0u;
    for (uint steps = 1u; steps <= band && found == 0u; ++steps) {
        beside += step_;
        if (!in_picture(beside)) break;
        seen = imageLoad(visibility, beside).xy;
        if (within || counts(seen.x)) found = steps;
    }
    return found;
}

// A face to ask about the pixel: the arguments of `candidate_at`, and whether there is one.
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

// A curved face can show its front at the same pixel, narrower than the tessellation's error: across the fold.
Question ask_across_fold(Situation s, vec2 direction) {
    uvec2 seen = uvec2(s.seen.x, pack_uv(unpack_uv(s.seen.y) + ACROSS * direction));
    return Question(true, seen, FROM_FOLD, RADIUS_OF_OUTSIDE);
}

// A neighbour; or, where it shows no patch, what that tells the situation.
Question ask_beside(inout Situation s, ivec2 at, ivec2 step_, bool within) {
    ivec2 beside;
    uvec2 seen;
    uint band = is_interior(s) ? WIDE_BAND_PX : BAND_PX;
    uint steps = first_that_counts(at, step_, band, within, beside, seen);
    bool nothing = steps == 1u && sees_nothing(seen.x);
    uvec2 there = nothing && SCENE_HAS_MESHES_OR_SOLIDS ? imageLoad(others, beside).xy : uvec2(0u);
    if (nothing && there.x == 0u) s.empty_beside = true;
    if (nothing && there.x != 0u) s.other_beside = true;
    return Question(steps != 0u && !sees_nothing(seen.x), seen, steps > 1u ? FROM_BEYOND : FROM_BESIDE, RADIUS_OF_OUTSIDE);
}

// All candidates, the own face first, and what the neighbours show beside patches. `within`: the eye is within a solid, so
// what is seen of it is from behind, and counts though it is marked. One call of `candidate_at`, which drivers copy to
// where it is called:
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
