// The point of a face's exact surface under a pixel, and whether the face is there. Needs trim.glsl, placed.glsl,
// refine.glsl and patch_place.glsl.
#ifndef FACE_POINT_GLSL
#define FACE_POINT_GLSL

#include "on_pixel.glsl"

// The same for the end of a face without trims: single precision, and the error of Newton's method after 100 pixels.
const float ROUNDED = 1e-5;

// Whether (u, v) of an untrimmed patch is in it, or in a patch beside it that lies within the loops. A surface
// continues beyond its own end, but the face does not, unless it goes on over the seam there.
bool in_whole_patch(FaceInstance fi, Face face, uint patch_instance, vec2 uv, bvec2 meets) {
    ivec2 count = ivec2(face.count_u, face.count_v);
    ivec2 place = place_of(face, int(patch_instance - fi.first_patch_instance)) + way_beyond(uv, ROUNDED);
    place = mix(place, (place + count) % count, meets);
    if (any(lessThan(place, ivec2(0))) || any(greaterThanEqual(place, count))) return false;
    return side_of(patch_at(patch_in(face, place)).shape) != SIDE_OUTSIDE;
}

// Whether the face is there at (u, v) of its patch. The table has rows only near the face's border: not for
// strips and bins in which all patches are whole.
bool is_there(FaceInstance fi, Face face, uint patch_instance, Patch patch_, vec2 uv) {
    if ((face.flags & FACE_TRIMMED) == 0u) return in_whole_patch(fi, face, patch_instance, uv, bvec2(false));
    vec2 at = patch_.domain.xy + uv * patch_.domain.zw;
#ifdef TRIM_BY_TABLE
    if (side_of(patch_.shape) == SIDE_INSIDE) {
        if (clamp(uv, 0.0, 1.0) == uv) return true;
        bool known = table_covers(fi.first_bin, face.strips, at);
        if (!known) return in_whole_patch(fi, face, patch_instance, uv, bvec2(false));
    }
#endif
    return trim_inside(fi, face, at);
}

// Whether another patch of the face goes on at (u, v) of a patch. There the patch's own continuation is not the surface.
bool goes_on(FaceInstance fi, Face face, uint patch_instance, vec2 uv) {
    ivec2 count = ivec2(face.count_u, face.count_v);
    ivec2 place = place_of(face, int(patch_instance - fi.first_patch_instance));
    ivec2 next = clamp(place + way_beyond(uv, BEYOND), ivec2(0), count - 1);
    return next != place && side_of(patch_at(patch_in(face, next)).shape) != SIDE_OUTSIDE;
}

// Like `refine`, but continues in the next patch of the face if the point lies beyond a side. `patch_instance` becomes
// the last patch.
Sample refine_across(FaceInstance fi, Face face, View view, inout uint patch_instance, vec2 uv, vec2 pixel) {
    ivec2 count = ivec2(face.count_u, face.count_v);
    uint number = face.first_patch + patch_instance - fi.first_patch_instance;
    Patch patch_ = patch_at(number);
    Sample s;
    for (uint hop = 0u; hop <= MAX_HOPS; ++hop) {
        Sample t = refine(patch_, view, uv, pixel);
        // beside a silhouette the next patch may come less near; then the continuation of the first one is better
        bool on = hop == 0u || length(t.miss) <= max(length(s.miss), ON_PIXEL_PX);
        if (on) {
            patch_instance = fi.first_patch_instance + number - face.first_patch;
            s = t;
        }
        if (!on) break; // only here: see refine.glsl
        ivec2 place = place_of(face, int(patch_instance - fi.first_patch_instance));
        ivec2 next = clamp(place + way_beyond(s.uv, BEYOND), ivec2(0), count - 1);
        number = patch_in(face, next);
        Patch there = patch_at(number);
        if (next == place || side_of(there.shape) == SIDE_OUTSIDE) break; // such a patch has no control points
        uv = (patch_.domain.xy + s.uv * patch_.domain.zw - there.domain.xy) / there.domain.zw;
        uv = clamp(uv, 0.0, 1.0);
        patch_ = there;
    }
    return s;
}

#endif
