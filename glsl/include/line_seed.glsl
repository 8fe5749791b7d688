// Where the search for a fold beside an edge begins. Needs placed.glsl, patch_place.glsl, edges.glsl.
#ifndef LINE_SEED_GLSL
#define LINE_SEED_GLSL

// (u, v) of the face's domain beside the piece of an edge at parameter `t`.
vec2 beside_edge(vec4 ends, float t) { return mix(ends.xy, ends.zw, (t - SEED_END) / (1.0 - 2.0 * SEED_END)); }

// From patch `n` of the face to the patch there: its column and row, and (u, v) in it.
ivec2 seed_place(Face face, int n, vec2 beside, out Patch patch_, out vec2 uv) {
    ivec2 count = ivec2(face.count_u, face.count_v);
    ivec2 place = place_of(face, n);
    patch_ = patch_at(patch_in(face, place));
    uv = (beside - patch_.domain.xy) / patch_.domain.zw;
    bool arrived = false; // tested by the loop's condition, not by a `break`: see refine.glsl
    for (uint hop = 0u; hop < MAX_HOPS && !arrived; ++hop) {
        ivec2 next = clamp(place + way_beyond(uv, BEYOND), ivec2(0), count - 1);
        Patch there = patch_at(patch_in(face, next));
        arrived = next == place || side_of(there.shape) == SIDE_OUTSIDE;
        if (arrived) continue;
        patch_ = there;
        place = next;
        uv = (beside - patch_.domain.xy) / patch_.domain.zw;
    }
    return place;
}

#endif
