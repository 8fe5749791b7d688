// The fold of a face that is nearest to a pixel: where its normal is across the ray. Needs placed.glsl, patch.glsl,
// patch_place.glsl, refine.glsl, edge_seen.glsl, `frame`.
//
//      ╭─── cosine between normal and ray = 0
//     ╱
//    ╱   ·  pixel          Newton's method on the cosine, along the fold to the point next to the pixel
//
// det J, J = d(pixel) / d(u, v), is 0 at the same points, but at poles and tips, too. Towards a tip it falls faster than
// towards the fold beside it, so that its slope leads there. The cosine does not know how a patch is parametrised.
#ifndef FOLD_GLSL
#define FOLD_GLSL

#include "jets_beside.glsl"

// At a fold the sheet bends away from its tangent plane at once.
const float FOLD_SHEET_PX = 0.25;
// Splines have patches that are a few pixels wide, and the pixel sees the face some patches before its fold.
const uint FOLD_STEPS = 12u;
// Of the patch: between points whose difference is the slope of the cosine.
const float FOLD_DIFFERENCE = 1.0 / 512.0;
// Where a fold may lie beside the last patch of its face, of the patch; and of a window, beyond which the surface goes on
// as the window's polynomial does.
const float FOLD_BESIDE = 0.25;
const float FOLD_BESIDE_WINDOW = 8.0;
// A step is no longer than a quarter of a patch, or than this, over patches that are narrower.
const float FOLD_NARROW_PX = 1.0;
// Patches at most that a short step leads across.
const uint FOLD_HOPS = 8u;
// Where the surface is seen edge-on, a short way in the picture says little: beyond a cusp the cosine falls and rises
// again. So the last step has divided it by more than the 4 of a double root, or it is as small as single precision
// tells.
const float FOLD_FALLS = 1.0 / 8.0;
const float FOLD_LEAST_COSINE = 1.0 / 1024.0;
// A longer step ends the search: no fold is within reach. Near a fold the distance in the picture is the square of the
// distance on the surface, so a step is twice as long as the way that is left.
const float FOLD_FAR_PX = 16.0;
// The same of a step out of a patch: the next one may bend more.
const float FOLD_FAR_OUT_PX = 64.0;

// Where a face ends in a fold, rounding decides on which side of its end the fold is. So the place is tested that is a
// hundredth of a pixel before it. This is the share of the way back; in the picture that way is the share's square.
const float BEFORE_FOLD = 1.0 / 16.0;

// Cosine between normal and ray.
float cosine_at(Sample s, View view) {
    vec3 du = seen_from_eye(to_pixel(view, vec4(s.jet.du, 0.0)));
    vec3 dv = seen_from_eye(to_pixel(view, vec4(s.jet.dv, 0.0)));
    vec3 ray = frame.perspective != 0u ? normalize(seen_from_eye(s.q)) : vec3(0.0, 0.0, 1.0);
    return dot(normalize(cross(normalize(du), normalize(dv))), ray);
}

// Sides of a face beyond which its surface goes on, in a window of a deep zoom: where u, or v, is 0, and where it is 1.
bvec2 goes_on_before(Face face) {
    return notEqual(face.flags >> FACE_GOES_ON & uvec2(BORDER_U0, BORDER_V0), uvec2(0u));
}
bvec2 goes_on_after(Face face) {
    return notEqual(face.flags >> FACE_GOES_ON & uvec2(BORDER_U1, BORDER_V1), uvec2(0u));
}

// The sides of a patch may be poles, where the normal turns over: the way from u, or v, that leads to none of them.
float way_within(float at) { return at < 0.0 || at >= 0.5 && at <= 1.0 ? -FOLD_DIFFERENCE : FOLD_DIFFERENCE; }

// The fold of the face nearest to `pixel`, from (u, v) of a patch on and over into those beside it; false where there
// is none near. `at`: its place in the face's domain, beyond it where the way leads over a seam.
bool find_fold(Face face, int n, View view, vec2 uv, vec2 pixel, out Sample s, out vec2 at) {
    ivec2 count = ivec2(face.count_u, face.count_v);
    ivec2 place = place_of(face, n);
    Patch patch_ = patch_at(patch_in(face, place));
    bvec2 meets = notEqual(face.flags & uvec2(FACE_MEETS_U, FACE_MEETS_V), uvec2(0u));
    vec2 turns = vec2(0.0); // times over the seam
    float way = 1e9; // that is left, and not a step of it: a step in a narrow patch may be shorter than ARRIVED_PX
    bool arrived = false;
    float before = 1.0; // the cosine before the last step
    bool lost = false; // tested by the loop's condition, not by a `break`: see refine.glsl
    for (uint i = 0u; i <= FOLD_STEPS && !lost; ++i) {
        Net net = net_of(patch_);
        vec2 apart = vec2(way_within(uv.x), way_within(uv.y));
        Jet jets[3];
        jets_beside(net.first, patch_.shape, net.less, uv, apart, jets);
        s = sample_of(jets[0], net, view, uv, pixel);
        float g = cosine_at(s, view);
        arrived = way < ARRIVED_PX && abs(g) < max(FOLD_FALLS * before, FOLD_LEAST_COSINE);
        if (arrived || i == FOLD_STEPS) break;
        before = abs(g);
        float gu = (cosine_at(sample_of(jets[1], net, view, uv, pixel), view) - g) / apart.x;
        float gv = (cosine_at(sample_of(jets[2], net, view, uv, pixel), view) - g) / apart.y;
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
        bool is_far = way > FOLD_FAR_PX;
        bool is_farther = way > FOLD_FAR_OUT_PX;
        float patches = max(abs(to.x), abs(to.y));
        float shorter = max(min(patches / MAX_STEP, way / FOLD_NARROW_PX), 1.0);
        bool is_short = way <= FOLD_NARROW_PX * shorter;
        // where the surface is seen edge-on, a long way may be short in the picture
        if (patches > 1.0) way = max(way, FOLD_FAR_PX);
        to /= shorter;
        uv += to;
        ivec2 from = place;
        bool within = false; // of a patch, or beyond the last one
        for (uint hop = 0u; hop < FOLD_HOPS && !within; ++hop) {
            ivec2 out_ = place + way_beyond(uv, 0.0);
            ivec2 next = mix(clamp(out_, ivec2(0), count - 1), (out_ + count) % count, meets);
            Patch there = patch_at(patch_in(face, next));
            within = next == place || side_of(there.shape) == SIDE_OUTSIDE;
            if (within) continue;
            vec2 over = vec2(greaterThanEqual(out_, count)) - vec2(lessThan(out_, ivec2(0)));
            over = mix(vec2(0.0), over, meets);
            uv = (patch_.domain.xy + uv * patch_.domain.zw - over - there.domain.xy) / there.domain.zw;
            // a long step may lead across many narrow patches, whose slopes it does not know: it ends at the first
            if (!is_short || hop + 1u == FOLD_HOPS) uv = mix(uv, clamp(uv, 0.0, 1.0), notEqual(out_, place));
            turns += over;
            patch_ = there;
            place = next;
        }
        lost = is_far && (place == from || is_farther);
    }
    at = patch_.domain.xy + s.uv * patch_.domain.zw + turns;
    vec2 least = -mix(vec2(FOLD_BESIDE), vec2(FOLD_BESIDE_WINDOW), goes_on_before(face));
    vec2 most = 1.0 + mix(vec2(FOLD_BESIDE), vec2(FOLD_BESIDE_WINDOW), goes_on_after(face));
    bool within = clamp(s.uv, least, most) == s.uv;
    return within && arrived;
}

#endif
