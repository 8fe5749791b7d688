// The place of a patch in its face. Needs scene.glsl.
#ifndef PATCH_PLACE_GLSL
#define PATCH_PLACE_GLSL

// Most patches of a face that a surface is followed across: a patch may be smaller than a pixel.
const uint MAX_HOPS = 8u;
// Share of a patch's width: a point less far beyond its side lies on the side, up to rounding.
const float BEYOND = 1e-4;

// Column and row of the `n`th patch of a face.
ivec2 place_of(Face face, int n) {
    int across = int(max(face.count_u, 1u));
    return ivec2(n % across, n / across);
}

// The patch there.
uint patch_in(Face face, ivec2 place) { return face.first_patch + uint(place.y) * face.count_u + uint(place.x); }

// The direction in which a point lies beyond its patch, by more than `slack`.
ivec2 way_beyond(vec2 uv, float slack) {
    return ivec2(greaterThan(uv, vec2(1.0 + slack))) - ivec2(lessThan(uv, vec2(-slack)));
}

#endif
