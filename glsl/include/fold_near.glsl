// How far from a point of a face in the picture there is no fold: a bound, from the slopes there and the second
// derivatives of the patch and of those beside it. Needs placed.glsl, patch.glsl, patch_place.glsl, refine.glsl, `frame`.
//
//   u, v scaled so that the pixel moves by 1 with each:  J has columns of length 1, smallest singular value s;
//   |J(x) - J(0)| <= K |x|,  so J is regular for |x| < s / K,  and there |pixel(x) - pixel(0)| >= s |x| - K |x|^2 / 2
//   no fold is nearer than  s^2 / (2 K)
//
// Source: the inverse function theorem with constants, R. Abraham, J. Marsden, T. Ratiu, Manifolds, Tensor Analysis, and
// Applications, 1988, section 2.5.
#ifndef FOLD_NEAR_GLSL
#define FOLD_NEAR_GLSL

// What a search leaves of its way, and what a chord is off its edge.
const float NEAR_OFF_PX = 0.25;

// The largest bend of a patch and of the three beside its nearest corner, of the patch's (u, v).
vec3 bend_around(Face face, ivec2 place, Patch patch_, vec2 uv) {
    ivec2 count = ivec2(face.count_u, face.count_v);
    bvec2 meets = notEqual(face.flags & uvec2(FACE_MEETS_U, FACE_MEETS_V), uvec2(0u));
    vec3 bend = patch_.bend;
    ivec2 way = ivec2(mix(vec2(-1.0), vec2(1.0), greaterThan(uv, vec2(0.5))));
    for (int k = 1; k < 4; ++k) {
        ivec2 out_ = place + way * ivec2(k & 1, k >> 1);
        ivec2 next = mix(clamp(out_, ivec2(0), count - 1), (out_ + count) % count, meets);
        Patch there = patch_at(patch_in(face, next));
        vec2 size = patch_.domain.zw / there.domain.zw;
        bend = max(bend, there.bend * vec3(size.x * size.x, size.x * size.y, size.y * size.y));
    }
    return bend;
}

float largest_of(float a, float b, float c) { return 0.5 * (a + c) + sqrt(0.25 * (a - c) * (a - c) + b * b); }

// Pixels around a place of the picture, next to which the face is at (u, v) of its patch. None where the face is a window
// of a deep zoom beyond which the surface goes on: its bend there is not known.
float fold_free(Face face, ivec2 place, Patch patch_, View view, vec2 uv, vec2 pixel) {
    if (face.flags >> FACE_GOES_ON != 0u) return 0.0;
    Sample s = sample_at(patch_, net_of(patch_), view, uv, pixel);
    mat2 along = pixels_along(s, view);
    vec2 p = s.q.xy / s.q.w;
    vec3 across = (view.x.xyz - p.x * view.w.xyz) / s.q.w;
    vec3 down = (view.y.xyz - p.y * view.w.xyz) / s.q.w;
    float stretch = sqrt(largest_of(dot(across, across), dot(across, down), dot(down, down)));
    float u = length(along[0]);
    float v = length(along[1]);
    vec2 nearer = abs(vec2(dot(view.w.xyz, s.jet.du), dot(view.w.xyz, s.jet.dv)) / s.q.w);
    vec3 bend = stretch * bend_around(face, place, patch_, uv);
    bend += vec3(2.0 * nearer.x * u, nearer.x * v + nearer.y * u, 2.0 * nearer.y * v);
    float most = largest_of(bend.x / (u * u), bend.y / (u * v), bend.z / (v * v));
    float regular = 1.0 - abs(dot(along[0], along[1])) / (u * v);
    return regular / (2.0 * most) - length(s.miss);
}

#endif
