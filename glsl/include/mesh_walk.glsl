// Across a mesh from one of its triangles to the one that a point of the picture sees. Needs facet.glsl and a buffer
// `uint neighbours[]`: of the side opposite to each corner, the corner opposite to it in the triangle beyond; NO_TRIANGLE where
// there is none or several. Twin: src/twin/mesh_walk.rs.
//
//        c                 weights of the point, one a corner: all at least 0 within the triangle. Beyond the side opposite to
//       ╱ ╲    · point     the corner of the least the next triangle's own corner lies on the point's side, too, unless the
//      ╱   ╲  ╱            mesh folds back there: then the point does not see it
//     a ── b ╱
#ifndef MESH_WALK_GLSL
#define MESH_WALK_GLSL

const uint NO_TRIANGLE = 0xffffffffu;
// Triangles that are crossed: a pixel and a half of a mesh whose triangles are a sixteenth of a pixel wide.
const uint MOST_CROSSED = 32u;
// A weight of less below 0 is rounding.
const float WEIGHT_ROUNDING = 1e-5;

const uint WALK_MET = 0u;     // the triangle that the point sees
const uint WALK_GONE = 1u;    // the mesh ends or folds before the point
const uint WALK_TOO_FAR = 2u; // more triangles than are crossed

struct Met {
    uint end;
    uint triangle;
    float depth; // along the view axis
};

// A triangle as a pixel's middle sees it: homogeneous pixels of a corner and of the sides from there, relative to the middle,
// and their depths.
struct Facing {
    vec4 a; // x, y, depth, w
    vec4 b;
    vec4 c;
};

Facing facing_at(uint triangle, View view, vec2 middle) {
    vec3 a = positions[triangles[3u * triangle]];
    vec3 ab = positions[triangles[3u * triangle + 1u]] - a;
    vec3 ac = positions[triangles[3u * triangle + 2u]] - a;
    vec4 q = to_pixel(view, vec4(a, 1.0));
    vec4 qb = to_pixel(view, vec4(ab, 0.0));
    vec4 qc = to_pixel(view, vec4(ac, 0.0));
    precise vec2 from = q.xy - middle * q.w;
    precise vec2 along_b = qb.xy - middle * qb.w;
    precise vec2 along_c = qc.xy - middle * qc.w;
    return Facing(vec4(from, q.zw), vec4(along_b, qb.zw), vec4(along_c, qc.zw));
}

// Weights of the corners where the ray through a point, so far from the middle, meets the triangle's plane, and its depth;
// no numbers edge-on.
vec4 weights_of(Facing f, vec2 point) {
    precise vec2 a = f.a.xy - point * f.a.w;
    precise vec2 b = f.b.xy - point * f.b.w;
    precise vec2 c = f.c.xy - point * f.c.w;
    precise vec2 st = vec2(cross2(c, a), cross2(a, b)) / cross2(b, c);
    precise float first = 1.0 - st.x - st.y;
    precise float depth = f.a.z + st.x * f.b.z + st.y * f.c.z;
    return vec4(first, st, depth);
}

// From a triangle whose plane is nearer than `nearest`.
Met walk_to(uint triangle, View view, vec2 pixel, float nearest) {
    Met met = Met(WALK_TOO_FAR, triangle, 0.0);
    uint back = NO_TRIANGLE; // the corner opposite to the side that was crossed last
    uint before = NO_TRIANGLE;
    for (uint i = 0u; i <= MOST_CROSSED; ++i) {
        vec4 w = weights_of(facing_at(met.triangle, view, pixel), vec2(0.0));
        met.depth = w.w;
        uint least = w.x <= w.y ? (w.x <= w.z ? 0u : 2u) : (w.y <= w.z ? 1u : 2u);
        bool finite = !any(isnan(w)) && !any(isinf(w));
        // folded back
        bool folds = back != NO_TRIANGLE && w[back] < -WEIGHT_ROUNDING;
        uint next = neighbours[3u * met.triangle + least];
        if (!finite || folds || i == 0u && !(w.w < nearest)) met.end = WALK_GONE;
        // on the side between the two
        else if (w[least] >= -WEIGHT_ROUNDING || next != NO_TRIANGLE && next / 3u == before) met.end = WALK_MET;
        else if (next == NO_TRIANGLE) met.end = WALK_GONE;
        if (met.end != WALK_TOO_FAR) break;
        before = met.triangle;
        met.triangle = next / 3u;
        back = next % 3u;
    }
    return met;
}

#endif
