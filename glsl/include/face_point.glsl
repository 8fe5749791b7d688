// Where a face's exact surface passes a pixel, and whether the face is there. Needs trim.glsl, placed.glsl, refine.glsl and
// patch_place.glsl.
#ifndef FACE_POINT_GLSL
#define FACE_POINT_GLSL

#include "on_pixel.glsl"

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

#endif
