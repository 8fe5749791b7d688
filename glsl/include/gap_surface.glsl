// A face at the centre of a gap candidate, by its exact surface and its trims. Needs gap_candidate.glsl, trim.glsl,
// placed.glsl, refine.glsl, patch_place.glsl and facing.glsl; with WITHIN_VOLUME volume.glsl.
#ifndef GAP_SURFACE_GLSL
#define GAP_SURFACE_GLSL

// Points of the gap radius at which a face is tested: where the centre is inside, whether all are; where it is outside,
// whether some are.
const uint RADIUS_OF_INSIDE = 1u;
const uint RADIUS_OF_OUTSIDE = 2u;

// How many patches of its face a surface is followed across: a patch may be smaller than a pixel.
const uint MAX_HOPS = 8u;
// Of a patch's width: less beyond its side is rounding, and the side's own point.
const float BEYOND = 1e-4;
// The same for the end of a face without trims: single precision, and what Newton's method leaves of 100 pixels.
const float ROUNDED = 1e-5;

// Whether (u, v) of a patch that no loop cuts is in it, or in one beside it that the loops leave. A surface
// goes on beyond its own end, but the face does not.
bool in_whole_patch(FaceInstance fi, Face face, uint item, vec2 uv) {
    ivec2 count = ivec2(face.count_u, face.count_v);
    ivec2 place = place_of(face, int(item - fi.first_item)) + way_beyond(uv, ROUNDED);
    if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, count))) return false;
    return side_of(patch_at(patch_in(face, place)).shape) != SIDE_OUTSIDE;
}

// Whether the face is there at (u, v) of the item's patch. The table has rows only where its border runs: not
// for strips and bins in which all patches are whole.
bool is_there(FaceInstance fi, Face face, uint item, Patch patch_, vec2 uv) {
    if ((face.flags & FACE_TRIMMED) == 0u) return in_whole_patch(fi, face, item, uv);
    vec2 at = patch_.domain.xy + uv * patch_.domain.zw;
#ifdef TRIM_BY_TABLE
    if (side_of(patch_.shape) == SIDE_INSIDE) {
        if (clamp(uv, 0.0, 1.0) == uv) return true;
        if (!table_covers(fi.first_bin, face.strips, at)) return in_whole_patch(fi, face, item, uv);
    }
#endif
    return trim_inside(fi, face, at);
}

// `refine` from one patch of a face into the next where the point lies beyond a side. `item` becomes the
// one in which it ended.
Sample refine_across(FaceInstance fi, Face face, View view, inout uint item, vec2 uv, vec2 pixel) {
    ivec2 count = ivec2(face.count_u, face.count_v);
    uint number = face.first_patch + item - fi.first_item;
    Patch patch_ = patch_at(number);
    Sample s;
    for (uint hop = 0u; hop <= MAX_HOPS; ++hop) {
        Sample t = refine(patch_, view, uv, pixel);
        // beside a silhouette the next patch may not come as near: then the first one's continuation is better
        bool on = hop == 0u || length(t.miss) <= max(length(s.miss), ON_PIXEL_PX);
        if (on) {
            item = fi.first_item + number - face.first_patch;
            s = t;
        }
        if (!on) break; // only now: see refine.glsl
        ivec2 place = place_of(face, int(item - fi.first_item));
        ivec2 next = clamp(place + way_beyond(s.uv, BEYOND), ivec2(0), count - 1);
        number = patch_in(face, next);
        Patch there = patch_at(number);
        if (next == place || side_of(there.shape) == SIDE_OUTSIDE) break; // that has no control points
        uv = (patch_.domain.xy + s.uv * patch_.domain.zw - there.domain.xy) / there.domain.zw;
        uv = clamp(uv, 0.0, 1.0);
        patch_ = there;
    }
    return s;
}

// Whether the face's point at (u, v), which it has, lies within the gap radius of the pixel.
bool reaches(Patch patch_, View view, vec2 uv, vec2 pixel) {
    vec4 q = to_pixel(view, vec4(patch_jet(patch_.first, patch_.shape, uv).point, 1.0));
#ifdef WITHIN_VOLUME
    // each alone may reach to the pixel from beside the corner in which they meet
    if (!in_volume(q, ON_PX)) return false;
#endif
    return distance(q.xy / q.w, pixel) <= GAP_SLACK * frame.gap_radius_px;
}

// The face that `seen` names, at the pixel's centre, and, as RADIUS_OF_ of `radius` says, at points of the gap radius. One
// call of what takes long, which drivers copy to where it is called.
Candidate candidate_at(uvec2 seen, vec2 pixel, uint from, uint radius) {
    uint item = seen_item(seen.x);
    FaceInstance fi = face_instance_at(face_instance_of(item));
    Face face = face_at(fi.face);
    View view = view_at(fi.instance);
    Sample s = refine_across(fi, face, view, item, unpack_uv(seen.y), pixel);
    Patch patch_ = patch_at(face.first_patch + item - fi.first_item);
    uvec2 word = uvec2(item + 1u, pack_uv(clamp(s.uv, vec2(-1.0), vec2(2.0))));
    Candidate c = Candidate(ABSENT, from, fi.face + 1u, false, true, s.q.z, length(s.miss), vec2(0.0), word);
    bool within = true;
#ifdef WITHIN_VOLUME
    if (!in_volume(s.q, GAP_SLACK * frame.gap_radius_px)) return c;
    within = in_volume(s.q, ON_PX);
#endif
    bool passes = c.miss <= ON_PIXEL_PX;
    mat2 along = pixels_along(s, view);
    vec2 pu = along[0];
    vec2 pv = along[1];
    float det = pu.x * pv.y - pu.y * pv.x;
    bool has_slope = passes && !(abs(det) < 1e-12);
    if (passes) c.away = looks_away(det, face, instance_at(fi.instance));
    if (has_slope) {
        float zu = row_times(view.depth, vec4(s.jet.du, 0.0));
        float zv = row_times(view.depth, vec4(s.jet.dv, 0.0));
        c.slope = vec2(zu * pv.y - zv * pu.y, zv * pu.x - zu * pv.x) / det;
    }
    for (uint k = 0u; k <= DIRECTION_COUNT; ++k) {
        vec2 duv = vec2(0.0); // the centre first
        if (k != 0u) {
            vec2 step_ = frame.gap_radius_px * DIRECTIONS[k - 1u];
            duv = vec2(step_.x * pv.y - step_.y * pv.x, pu.x * step_.y - pu.y * step_.x) / det;
        }
        bool there = is_there(fi, face, item, patch_, s.uv + duv);
        bool settled;
        if (k == 0u) {
            c.inside = there && within;
            if (c.inside && passes) c.kind = PRESENT;
            // a silhouette beside the pixel
            if (c.inside && !passes && c.miss <= GAP_SLACK * frame.gap_radius_px) c.kind = NEAR;
            settled = !has_slope || (radius & (c.inside ? RADIUS_OF_INSIDE : RADIUS_OF_OUTSIDE)) == 0u;
        } else {
            settled = there != c.inside && (c.inside || reaches(patch_, view, s.uv + duv, pixel));
            if (settled) c.kind = NEAR;
        }
        if (settled) break;
    }
    return c;
}

// The border of a candidate near the pixel; see gap_decide.glsl.
Outline outline_of(Candidate c, vec2 pixel) {
    uint item = seen_item(c.word.x);
    FaceInstance fi = face_instance_at(face_instance_of(item));
    Face face = face_at(fi.face);
    Patch patch_ = patch_at(face.first_patch + item - fi.first_item);
    View view = view_at(fi.instance);
    Sample s = sample_at(patch_, net_of(patch_), view, unpack_uv(c.word.y), pixel);
    mat2 uv_along = inverse(pixels_along(s, view));
    // a word's (u, v) has 16 bits, which in a large patch are a part of a pixel
    vec2 at = s.uv - uv_along * s.miss;
    vec2 sum = vec2(0.0);
    bool there;
    for (uint k = 0u; k <= DIRECTION_COUNT; ++k) {
        bool last = k == DIRECTION_COUNT; // the other way
        vec2 step_ = frame.gap_radius_px * DIRECTIONS[k % DIRECTION_COUNT];
        if (last) step_ = -0.5 * frame.gap_radius_px / max(length(sum), 1e-6) * sum;
        there = is_there(fi, face, item, patch_, at + uv_along * step_);
        if (there && !last) sum += step_;
    }
    return Outline(sum, !there);
}

#endif
