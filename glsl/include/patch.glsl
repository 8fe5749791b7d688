// Evaluation of a rational Bézier patch. Twin of src/spline/patch.rs.
//
// Needs `samplerBuffer points` (one texel a homogeneous control point; weight 1 where a patch is
// polynomial) and, as specialisation constant 0, whether any patch of the scene
// is rational. Exact at the corners and along the sides: at u = 1 the row's last control point is
// returned bit for bit, so neighbouring patches meet without a crack.
#ifndef PATCH_GLSL
#define PATCH_GLSL

layout(constant_id = 0) const bool SCENE_HAS_RATIONAL = true;

struct Jet {
    vec3 point;
    vec3 du;
    vec3 dv;
};

// Value and slope of row `j`: Horner's scheme on the first n and on the last n control points.
void patch_row(uint first, uint n, uint j, float u, out vec4 value, out vec4 slope) {
    int at = int(first + j * (n + 1u));
    float s = 1.0 - u;
    vec4 p = texelFetch(points, at);
    vec4 q = texelFetch(points, at + 1);
    vec4 a = p;
    vec4 b = q;
    if (n > 1u) {
        uint m = n - 1u;
        float f = 1.0;
        float c = 1.0;
        a *= s;
        b *= s;
        for (uint i = 1u; i < m; ++i) {
            p = q;
            q = texelFetch(points, at + int(i) + 1);
            f *= u;
            c *= float(m - i + 1u) / float(i);
            a = (a + p * (f * c)) * s;
            b = (b + q * (f * c)) * s;
        }
        p = q;
        q = texelFetch(points, at + int(n));
        f *= u;
        a += p * f;
        b += q * f;
    }
    value = a * s + b * u;
    slope = (b - a) * float(n);
}

// Point and first derivatives at (u, v); parameters outside [0, 1] extrapolate.
Jet patch_jet(uint first, uint shape, vec2 uv) {
    uint n = degree_u(shape);
    uint k = degree_v(shape);
    bool rational = SCENE_HAS_RATIONAL && is_rational(shape);
    float v = uv.y;
    float s = 1.0 - v;
    vec4 p, ps, q, qs;
    patch_row(first, n, 0u, uv.x, p, ps);
    patch_row(first, n, 1u, uv.x, q, qs);
    vec4 a = p;
    vec4 b = q;
    vec4 slope;
    // k = 0 is read by lanes of a SIMD driver that only keep others company: k - 1 below would wrap, and
    // llvmpipe ends every loop of the shader after 65,535 steps, the others' too
    if (k <= 1u) {
        slope = ps * s + qs * v;
    } else {
        // values: degree k - 1 twice, as along u; slopes: degree k once
        uint m = k - 1u;
        float f = 1.0;
        float c = 1.0;
        float d = 1.0;
        a *= s;
        b *= s;
        slope = ps * s;
        for (uint j = 1u; j < m; ++j) {
            f *= v;
            d *= float(k - j + 1u) / float(j);
            slope = (slope + qs * (f * d)) * s;
            p = q;
            patch_row(first, n, j + 1u, uv.x, q, qs);
            c *= float(m - j + 1u) / float(j);
            a = (a + p * (f * c)) * s;
            b = (b + q * (f * c)) * s;
        }
        f *= v;
        d *= float(k - m + 1u) / float(m);
        slope = (slope + qs * (f * d)) * s;
        p = q;
        patch_row(first, n, k, uv.x, q, qs);
        a += p * f;
        b += q * f;
        slope += qs * (f * v);
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

#endif
