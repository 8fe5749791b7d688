#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `baseline_slefe`, in place of `bound`: divides patches by the largest extent of their slefe boxes in pixels.
// Weights are ignored, as in the source: Y. I. Yeo, L. Bin, J. Peters, Efficient pixel-accurate rendering of curved
// surfaces, 2012. One thread a patch instance. The same in f64: Way::Ipass of src/baselines/factors.
#include "bound.glsl"

layout(scalar, binding = 12) readonly buffer Slefes {
    uint segments;
    vec2 basis[]; // U_j, L_j at each break point, j after j, degree after degree from 2 on: src/baselines/slefe
};

const uint MOST_DEGREE = 9u;
// More segments than the engine counts: a clamp.
const float NO_ANSWER = 1.0e30;

struct Bounds {
    vec3 lower;
    vec3 upper;
};

// The linear part of a polynomial, between its first and last coefficient.
Bounds linear(Bounds first, Bounds last, float t) {
    return Bounds(mix(first.lower, last.lower, t), mix(first.upper, last.upper, t));
}

// Adds the contribution of second difference `j` of degree `n` at a break point; `lower` is for the lower bound.
void add(inout Bounds bounds, uint n, uint j, uint at, vec3 lower, vec3 upper) {
    vec2 b = basis[((n - 1u) * (n - 2u) / 2u + j - 1u) * (segments + 1u) + at];
    bounds.lower += max(lower, 0.0) * b.y + min(lower, 0.0) * b.x;
    bounds.upper += max(upper, 0.0) * b.x + min(upper, 0.0) * b.y;
}

// Relative to `origin`, which keeps digits in differences.
vec3 point_at(uint i, vec3 origin) {
    vec4 p = texelFetch(points, int(i));
    return p.xyz / p.w - origin;
}

// The bounds of the row of `n + 1` points from `first` on, at break point `at`.
Bounds row_bounds(uint first, uint n, uint at, vec3 origin) {
    vec3 a = point_at(first, origin);
    vec3 z = point_at(first + n, origin);
    Bounds row = linear(Bounds(a, a), Bounds(z, z), float(at) / float(segments));
    vec3 b = point_at(first + 1u, origin);
    for (uint j = 1u; j < n; ++j) {
        vec3 c = point_at(first + j + 1u, origin);
        vec3 second = a - 2.0 * b + c;
        add(row, n, j, at, second, second);
        a = b;
        b = c;
    }
    return row;
}

// The larger extent in pixels of the box of half size `reach` around the homogeneous pixel `q`.
float extent(View view, vec4 q, vec3 reach) {
    vec2 pixel = q.xy / q.w;
    vec2 low = vec2(0.0);
    vec2 high = vec2(0.0);
    for (uint i = 0u; i < 8u; ++i) {
        vec3 c = mix(-reach, reach, notEqual(uvec3(i) & uvec3(1u, 2u, 4u), uvec3(0u)));
        float w = dot(view.w.xyz, c);
        if (frame.perspective != 0u && q.w + w <= frame.near) return NO_ANSWER;
        vec2 off = (vec2(dot(view.x.xyz, c), dot(view.y.xyz, c)) - pixel * w) / (q.w + w);
        low = min(low, off);
        high = max(high, off);
    }
    return max(high.x - low.x, high.y - low.y);
}

vec2 factors_of(Patch patch_, View view, uint instance, Seen seen) {
    uint n = degree_u(patch_.shape);
    uint k = degree_v(patch_.shape);
    if (max(n, k) > MOST_DEGREE) return vec2(NO_ANSWER);
    vec3 origin = point_at(patch_.first, vec3(0.0));
    float widest = 0.0;
    Bounds rows[MOST_DEGREE + 1u];
    for (uint i = 0u; i <= segments; ++i) {
        for (uint j = 0u; j <= k; ++j) rows[j] = row_bounds(patch_.first + j * (n + 1u), n, i, origin);
        for (uint at = 0u; at <= segments; ++at) {
            Bounds tile = linear(rows[0], rows[k], float(at) / float(segments));
            for (uint j = 1u; j < k; ++j) {
                vec3 lower = rows[j - 1u].lower - 2.0 * rows[j].lower + rows[j + 1u].lower;
                vec3 upper = rows[j - 1u].upper - 2.0 * rows[j].upper + rows[j + 1u].upper;
                add(tile, k, j, at, lower, upper);
            }
            vec4 q = to_pixel(view, vec4(origin + 0.5 * (tile.lower + tile.upper), 1.0));
            widest = max(widest, extent(view, q, 0.5 * (tile.upper - tile.lower)));
        }
    }
    return vec2(max(ceil(float(segments) * sqrt(widest / frame.deviation_px)), 1.0));
}
