// Evaluation of a rational Bézier patch. Twin of crates/geometry/src/spline/patch.rs.
//
// Needs `samplerBuffer points` (one texel a homogeneous control point; weight 1 for polynomial patches) and, as
// specialisation constant 0, whether any patch of the scene is rational. Exact at the corners and along the sides: at u
// = 1 the row's last control point is returned bit for bit, so neighbouring patches meet without a crack.
#ifndef PATCH_GLSL
#define PATCH_GLSL

layout(constant_id = 0) const bool SCENE_HAS_RATIONAL = true;

struct Jet {
    vec3 point;
    vec3 du;
    vec3 dv;
};

// Binomials times powers, one by one: w_i = (m over i) t^i.
struct Weights {
    float power;
    float choose;
};

float weight_of(Weights w) { return w.power * w.choose; }

// From w_i to w_(i + 1); the last is the power itself.
void advance(inout Weights w, uint m, uint i, float t) {
    w.power *= t;
    w.choose = i + 1u < m ? w.choose * (float(m - i) / float(i + 1u)) : 1.0;
}

// A homogeneous control point relative to `base`.
vec4 control_point(int at, vec3 base) {
    vec4 p = texelFetch(points, at);
    return vec4(p.xyz - base * p.w, p.w);
}

// Value and slope of row `j`: Horner's scheme on the first n and on the last n control points. One loop over the whole
// row, here and below: a software rasteriser runs the code behind a branch, and each loop once, even if no lane needs
// it.
void patch_row(uint first, uint n, uint j, vec3 base, float u, out vec4 value, out vec4 slope) {
    int at = int(first + j * (n + 1u));
    float s = 1.0 - u;
    vec4 a = vec4(0.0);
    vec4 b = vec4(0.0);
    Weights w = Weights(1.0, 1.0);
    float before = 0.0;
    for (uint i = 0u; i <= n; ++i) {
        vec4 p = control_point(at + int(i), base);
        b = b * s + p * before;
        if (i < n) a = a * s + p * weight_of(w);
        before = weight_of(w);
        advance(w, n - 1u, i, u);
    }
    value = a * s + b * u;
    slope = (b - a) * float(n);
}

// Point, less `base`, and first derivatives at (u, v); parameters outside [0, 1] extrapolate. Derivatives are
// differences of points. For a small patch far from the origin they keep only the points' digits, unless `base` is
// near.
Jet patch_jet_from(uint first, uint shape, vec3 base, vec2 uv) {
    uint n = degree_u(shape);
    uint k = degree_v(shape);
    bool rational = SCENE_HAS_RATIONAL && is_rational(shape);
    float v = uv.y;
    float s = 1.0 - v;
    // values: degree k - 1 twice, as along u; slopes: degree k once
    vec4 a = vec4(0.0);
    vec4 b = vec4(0.0);
    vec4 slope = vec4(0.0);
    Weights w = Weights(1.0, 1.0);
    Weights wide = w;
    float before = 0.0;
    for (uint j = 0u; j <= k; ++j) {
        vec4 p, along;
        patch_row(first, n, j, base, uv.x, p, along);
        b = b * s + p * before;
        if (j < k) a = a * s + p * weight_of(w);
        slope = slope * s + along * weight_of(wide);
        before = weight_of(w);
        advance(w, k - 1u, j, v);
        advance(wide, k, j, v);
    }
    vec4 value = a * s + b * v;
    vec4 across = (b - a) * float(k);
    Jet jet;
    if (rational) {
        float w = 1.0 / value.w;
        jet.point = value.xyz * w;
        jet.du = (slope.xyz - jet.point * slope.w) * w;
        jet.dv = (across.xyz - jet.point * across.w) * w;
    } else {
        jet.point = value.xyz;
        jet.du = slope.xyz;
        jet.dv = across.xyz;
    }
    return jet;
}

// The point of a corner, (u, v) of 0 and 1: its control point, which the evaluation returns there bit for bit.
vec3 patch_corner(uint first, uint shape, uvec2 uv) {
    uint n = degree_u(shape);
    vec4 p = texelFetch(points, int(first + uv.x * n + uv.y * degree_v(shape) * (n + 1u)));
    return SCENE_HAS_RATIONAL && is_rational(shape) ? p.xyz * (1.0 / p.w) : p.xyz;
}

Jet patch_jet(uint first, uint shape, vec2 uv) { return patch_jet_from(first, shape, vec3(0.0), uv); }

#endif
