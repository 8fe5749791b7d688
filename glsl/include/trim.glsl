// Whether a point of a face is inside its trims: the interface between passes and the ways to trim. The entry point
// defines TRIM_BY_<WAY>; the includer declares `frame` and defines TRIM_BINDING, the first of the way's own buffers.
// Each way defines
//
//   bool trim_inside(FaceInstance fi, Face face, vec2 uv)     (u, v) normalised to the face's surface;
//                                                             face has FACE_TRIMMED
//   uint trim_area(FaceInstance fi, Face face, vec2 lo, vec2 hi)
//                                                             of a box in (u, v): all of it inside, all of it
//                                                             outside, all of it like any point of it, or
//                                                             undecided
#ifndef TRIM_GLSL
#define TRIM_GLSL

const uint TRIM_OUT = 0u;
const uint TRIM_IN = 1u;
const uint TRIM_MIXED = 2u;
const uint TRIM_SAME = 3u;

#ifdef TRIM_BY_TABLE
#define TRIM_BUFFERS 4
#define TABLE_BINDING TRIM_BINDING
#include "table.glsl"

bool trim_inside(FaceInstance fi, Face face, vec2 uv) {
    return table_inside(fi.first_bin, face.strips, uv);
}

uint trim_area(FaceInstance fi, Face face, vec2 lo, vec2 hi) {
    return table_same(fi.first_bin, face.strips, lo, hi) ? TRIM_SAME : TRIM_MIXED;
}
#endif

#ifdef TRIM_BY_EXACT
#define TRIM_BUFFERS 3
#define EXACT_BINDING TRIM_BINDING
#include "exact.glsl"

bool trim_inside(FaceInstance fi, Face face, vec2 uv) {
    return exact_winding(fi.face, uv) != 0;
}

#endif

#if !defined(TRIM_BY_TABLE) && !defined(TRIM_BY_BISECT)
uint trim_area(FaceInstance fi, Face face, vec2 lo, vec2 hi) {
    return TRIM_MIXED;
}
#endif

// No face of the scene has trims; or a baseline that tests none of them.
#ifdef TRIM_BY_UNTRIMMED
#define TRIM_BUFFERS 0
bool trim_inside(FaceInstance fi, Face face, vec2 uv) {
    return true;
}
#endif

// Baselines: src/baselines.
#ifdef TRIM_BY_BISECT
#include "baselines/bisect.glsl"
#endif

#ifdef TRIM_BY_TEXTURE
#include "baselines/texture.glsl"
#include "words.glsl"
layout(binding = TRIM_BINDING + 0) uniform usamplerBuffer texture_places;
layout(binding = TRIM_BINDING + 1) uniform usamplerBuffer texels;

bool trim_inside(FaceInstance fi, Face face, vec2 uv) {
    if (any(lessThan(uv, vec2(0.0))) || any(greaterThanEqual(uv, vec2(1.0)))) return false;
    uvec4 words = texelFetch(texture_places, int(fi.first_bin));
    TexturePlace place = TexturePlace(TextureSize(words.x, words.y, words.z), words.w);
    if (place.size.words == 0u) return false;
    uint column = min(uint(uv.x * float(place.size.columns)), place.size.columns - 1u);
    uint row = min(uint(uv.y * float(place.size.rows)), place.size.rows - 1u);
    return (word_at(texels, place.start + row * place.size.words + column / 32u) >> (column & 31u) & 1u) != 0u;
}
#endif

#endif
