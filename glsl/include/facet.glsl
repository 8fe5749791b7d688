// The intersection of the ray through a pixel with the plane of a triangle. Needs view.glsl and buffers
// `uint triangles[]`, `vec3 positions[]`.
//
//   a + s (b - a) + t (c - a),   s, t >= 0,   s + t <= 1
//
// The rasteriser rounds corners to a fraction of a pixel, so the ray may miss the triangle slightly; then the
// triangle's nearest point is taken. The result has the same bits in every pass.
#ifndef FACET_GLSL
#define FACET_GLSL

struct Facet {
    vec3 ab; // sides, part coordinates
    vec3 ac;
    vec2 st;
    float depth;
};

float cross2(vec2 a, vec2 b) {
    precise float area = a.x * b.y - a.y * b.x;
    return area;
}

// The normal of two sides, divided by their size, since the product of small sides would underflow.
vec3 across(vec3 ab, vec3 ac) {
    float side = max(max(dot(ab, ab), dot(ac, ac)), 1e-36);
    return cross(ab * inversesqrt(side), ac * inversesqrt(side));
}

vec3 facet_normal(uint triangle) {
    vec3 a = positions[triangles[3u * triangle]];
    return across(positions[triangles[3u * triangle + 1u]] - a, positions[triangles[3u * triangle + 2u]] - a);
}

Facet facet_at(uint triangle, View view, vec2 pixel) {
    Facet f;
    vec3 a = positions[triangles[3u * triangle]];
    f.ab = positions[triangles[3u * triangle + 1u]] - a;
    f.ac = positions[triangles[3u * triangle + 2u]] - a;
    // pixels times W, relative to the pixel: zero at the wanted point
    vec4 q = to_pixel(view, vec4(a, 1.0));
    vec4 qb = to_pixel(view, vec4(f.ab, 0.0));
    vec4 qc = to_pixel(view, vec4(f.ac, 0.0));
    precise vec2 from = q.xy - pixel * q.w;
    precise vec2 along_b = qb.xy - pixel * qb.w;
    precise vec2 along_c = qc.xy - pixel * qc.w;
    float area = cross2(along_b, along_c);
    precise vec2 st = vec2(cross2(along_c, from), cross2(from, along_b)) / area;
    if (area == 0.0 || any(isnan(st)) || any(isinf(st))) st = vec2(1.0 / 3.0); // edge-on
    st = max(st, 0.0);
    precise vec2 within = st / max(st.x + st.y, 1.0);
    precise float depth = q.z + within.x * qb.z + within.y * qc.z;
    f.st = within;
    f.depth = depth;
    return f;
}

#endif
