// The fold of a face that is nearest to a pixel: where its normal is across the ray. Needs placed.glsl, patch.glsl,
// patch_place.glsl, refine.glsl, edge_seen.glsl, `frame`.
//
//      ╭─── det J = 0, J = d(pixel) / d(u, v)
//     ╱
//    ╱   ·  pixel          Newton's method on det J, along the fold to the point next to the pixel
#ifndef FOLD_GLSL
#define FOLD_GLSL

// At a fold the sheet bends away from its tangent plane at once.
const float FOLD_SHEET_PX = 0.25;
// Near a pole a step of a quarter of a patch is a short way.
const uint FOLD_STEPS = 12u;
// Of the patch: between points whose difference is the slope of det J.
const float FOLD_DIFFERENCE = 1.0 / 512.0;
// Where a fold may lie beside the last patch of its face, of the patch: across the seam of a closed surface.
const float FOLD_BESIDE = 0.25;
// Largest cosine between normal and ray at a fold: det J is 0 at poles, too.
const float FOLD_COSINE = 0.2;
// A longer step ends the search: no fold is within reach. Near a fold the distance in the picture is the square of the
// distance on the surface, so a step is twice as long as the way that is left.
const float FOLD_FAR_PX = 16.0;
// A step is no longer than a quarter of a patch; than a whole one where that is no longer than this.
const float FOLD_NARROW_PX = 1.0;

// Where a face ends in a fold, rounding decides on which side of its end the fold is. So the place is tested that is a
// hundredth of a pixel before it. This is the share of the way back; in the picture that way is the share's square.
const float BEFORE_FOLD = 1.0 / 16.0;

float fold_at(Sample s, View view) {
    mat2 along = pixels_along(s, view);
    return along[0].x * along[1].y - along[0].y * along[1].x;
}

// The fold of the face nearest to `pixel`, from (u, v) of a patch on and over into those beside it; false where there
// is none near. `at`: its place in the face's domain.
bool find_fold(Face face, int n, View view, vec2 uv, vec2 pixel, out Sample s, out vec2 at) {
    ivec2 count = ivec2(face.count_u, face.count_v);
    ivec2 place = place_of(face, n);
    Patch patch_ = patch_at(patch_in(face, place));
    float way = 1e9; // that is left, and not a step of it: a quarter of a narrow patch may be shorter than ARRIVED_PX
    bool lost = false; // tested by the loop's condition, not by a `break`: see refine.glsl
    for (uint i = 0u; i <= FOLD_STEPS && !lost; ++i) {
        Net net = net_of(patch_);
        s = sample_at(patch_, net, view, uv, pixel);
        if (way < ARRIVED_PX || i == FOLD_STEPS) break;
        float g = fold_at(s, view);
        Sample beside = sample_at(patch_, net, view, uv + vec2(FOLD_DIFFERENCE, 0.0), pixel);
        float gu = (fold_at(beside, view) - g) / FOLD_DIFFERENCE;
        beside = sample_at(patch_, net, view, uv + vec2(0.0, FOLD_DIFFERENCE), pixel);
        float gv = (fold_at(beside, view) - g) / FOLD_DIFFERENCE;
        vec2 slope = vec2(gu, gv);
        float steep = dot(slope, slope);
        if (!(steep > 0.0)) return false;
        // to the fold, then along it to the point next to the pixel
        vec2 to = -g / steep * slope;
        mat2 along = pixels_along(s, view);
        vec2 fold = vec2(-gv, gu);
        vec2 run = along * fold;
        float runs = dot(run, run);
        if (runs > 0.0) to -= dot(s.miss + along * to, run) / runs * fold;
        way = length(along * to);
        lost = way > FOLD_FAR_PX;
        vec2 size = abs(to);
        float patches = max(size.x, size.y);
        to /= max(min(patches / MAX_STEP, max(patches, way / FOLD_NARROW_PX)), 1.0);
        uv += to;
        ivec2 next = clamp(place + way_beyond(uv, 0.0), ivec2(0), count - 1);
        Patch there = patch_at(patch_in(face, next));
        if (next == place || side_of(there.shape) == SIDE_OUTSIDE) continue;
        uv = (patch_.domain.xy + uv * patch_.domain.zw - there.domain.xy) / there.domain.zw;
        // a quarter of a wide patch may be many narrow ones: far beyond its sides a patch is not the surface
        uv = mix(uv, clamp(uv, 0.0, 1.0), notEqual(next, place));
        patch_ = there;
        place = next;
    }
    at = patch_.domain.xy + s.uv * patch_.domain.zw;
    bool within = all(greaterThanEqual(s.uv, vec2(-FOLD_BESIDE))) && all(lessThanEqual(s.uv, vec2(1.0 + FOLD_BESIDE)));
    vec3 du = seen_from_eye(to_pixel(view, vec4(s.jet.du, 0.0)));
    vec3 dv = seen_from_eye(to_pixel(view, vec4(s.jet.dv, 0.0)));
    vec3 ray = frame.perspective != 0u ? normalize(seen_from_eye(s.q)) : vec3(0.0, 0.0, 1.0);
    float cosine = abs(dot(normalize(cross(normalize(du), normalize(dv))), ray));
    return within && !lost && way < ARRIVED_PX && cosine < FOLD_COSINE;
}

#endif
