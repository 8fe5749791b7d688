// The place of a patch in its face. Needs scene.glsl.
#ifndef PATCH_PLACE_GLSL
#define PATCH_PLACE_GLSL

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
