// A face at the centre of a gap candidate, by its exact surface and its trims. Needs gap_candidate.glsl,
// face_point.glsl and facing.glsl; with WITHIN_VOLUME volume.glsl.
#ifndef GAP_SURFACE_GLSL
#define GAP_SURFACE_GLSL

// The points of the gap radius at which a face is tested: if the centre is inside, whether all are; if it is outside,
// whether some are.
const uint RADIUS_OF_INSIDE = 1u;
const uint RADIUS_OF_OUTSIDE = 2u;

// Whether the face's point at (u, v), which is inside its trims, lies within the gap radius of the pixel.
bool reaches(Patch patch_, View view, vec2 uv, vec2 pixel) {
    vec4 q = to_pixel(view, vec4(patch_jet(patch_.first, patch_.shape, uv).point, 1.0));
#ifdef WITHIN_VOLUME
    // faces that meet in a corner may each reach the pixel from beside it
    if (!in_volume(q, ON_PX)) return false;
#endif
    return distance(q.xy / q.w, pixel) <= GAP_SLACK * frame.gap_radius_px;
}

// The face of the word `seen` at the pixel's centre and, as the RADIUS_OF_ bits of `radius` say, at points of the gap
// radius. The expensive part is called once, since drivers inline it.
Candidate candidate_at(uvec2 seen, vec2 pixel, uint from, uint radius) {
    uint patch_instance = seen_patch_instance(seen.x);
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Face face = face_at(fi.face);
    View view = view_at(fi.instance);
    Sample s = refine_across(fi, face, view, patch_instance, unpack_uv(seen.y), pixel);
    Patch patch_ = patch_at(face.first_patch + patch_instance - fi.first_patch_instance);
    uvec2 word = uvec2(patch_instance + 1u, pack_uv(clamp(s.uv, vec2(-1.0), vec2(2.0))));
    Candidate c = Candidate(ABSENT, from, fi.face + 1u, fi.instance, false, true, s.q.z, length(s.miss), vec2(0.0), word);
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
        bool there = is_there(fi, face, patch_instance, patch_, s.uv + duv);
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
    uint patch_instance = seen_patch_instance(c.word.x);
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Face face = face_at(fi.face);
    Patch patch_ = patch_at(face.first_patch + patch_instance - fi.first_patch_instance);
    View view = view_at(fi.instance);
    Sample s = sample_at(patch_, net_of(patch_), view, unpack_uv(c.word.y), pixel);
    mat2 uv_along = inverse(pixels_along(s, view));
    // a word's (u, v) has 16 bits, which in a large patch are more than a pixel
    vec2 at = s.uv - uv_along * s.miss;
    vec2 sum = vec2(0.0);
    bool there;
    for (uint k = 0u; k <= DIRECTION_COUNT; ++k) {
        bool last = k == DIRECTION_COUNT; // the opposite direction
        vec2 step_ = frame.gap_radius_px * DIRECTIONS[k % DIRECTION_COUNT];
        if (last) step_ = -0.5 * frame.gap_radius_px / max(length(sum), 1e-6) * sum;
        there = is_there(fi, face, patch_instance, patch_, at + uv_along * step_);
        if (there && !last) sum += step_;
    }
    return Outline(sum, !there);
}

#endif
