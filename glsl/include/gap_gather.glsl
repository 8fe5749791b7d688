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

// The situation but for what the neighbours show.
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
    uint radius = s.border ? RADIUS_OF_INSIDE | RADIUS_OF_OUTSIDE : RADIUS_OF_INSIDE;
    if (!s.empty) s.own = candidate_at(seen, pixel, FROM_BESIDE, radius);
    s.seen = seen;
#ifdef WITHIN_VOLUME
    s.cut_open = true;
#else
    s.cut_open = false;
#endif
    return s;
}

// A curved face can show its front at the same pixel, narrower than the tessellation's error: across the fold.
void gather_across_fold(inout Evidence e, Situation s, vec2 pixel) {
    for (uint k = 0u; k < DIRECTION_COUNT; ++k) {
        uvec2 seen = uvec2(s.seen.x, pack_uv(unpack_uv(s.seen.y) + ACROSS * DIRECTIONS[k]));
        consider(e, s, candidate_at(seen, pixel, FROM_FOLD, RADIUS_OF_OUTSIDE));
    }
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

// All candidates, and what the neighbours show beside patches. `within`: the eye is within a solid, so what is seen of it
// is from behind, and counts though it is marked.
Evidence gather(inout Situation s, ivec2 at, vec2 pixel, bool within) {
    Evidence e = no_evidence(s);
    if (!s.border) gather_across_fold(e, s, pixel);
    uint band = is_interior(s) ? WIDE_BAND_PX : BAND_PX;
    for (uint k = 0u; k < DIRECTION_COUNT; ++k) {
        ivec2 beside;
        uvec2 seen;
        uint steps = first_that_counts(at, ivec2(sign(DIRECTIONS[k])), band, within, beside, seen);
        if (steps == 0u) continue;
        if (sees_nothing(seen.x)) {
            if (steps > 1u) continue;
            uvec2 there = SCENE_HAS_MESHES_OR_SOLIDS ? imageLoad(others, beside).xy : uvec2(0u);
            // a mesh or solid before the own face may hide its neighbour: it tells nothing
            if (there.x == 0u) s.empty_beside = true;
            else if (other_depth(there, vec2(beside) + 0.5) > s.own.depth) s.other_beside = true;
            continue;
        }
        uint from = steps > 1u ? FROM_BEYOND : FROM_BESIDE;
        consider(e, s, candidate_at(seen, pixel, from, RADIUS_OF_OUTSIDE));
    }
    return e;
}

#endif
