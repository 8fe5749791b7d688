// A point of a patch, and those beside it along u and along v, at once: bit for bit those of `patch_jet_from`. Each
// control point is fetched once, and each row computed twice, in place of three times. Needs patch.glsl.
#ifndef JETS_BESIDE_GLSL
#define JETS_BESIDE_GLSL

// Sums of Horner's scheme for one place.
struct Sums {
    vec4 a;
    vec4 b;
    vec4 slope;
};

// A row's control point, or a row's value and slope, at one parameter.
void put_row(inout vec4 a, inout vec4 b, inout Weights w, inout float before, vec4 p, uint i, uint n, float t) {
    float s = 1.0 - t;
    b = b * s + p * before;
    if (i < n) a = a * s + p * weight_of(w);
    before = weight_of(w);
    advance(w, n - 1u, i, t);
}

void put_column(inout Sums c, vec4 value, vec4 along, float before, Weights w, Weights wide, bool is_first, float s) {
    c.b = c.b * s + value * before;
    if (is_first) c.a = c.a * s + value * weight_of(w);
    c.slope = c.slope * s + along * weight_of(wide);
}

Jet jet_of(Sums c, uint k, float v, bool rational) {
    vec4 value = c.a * (1.0 - v) + c.b * v;
    vec4 across = (c.b - c.a) * float(k);
    Jet jet;
    if (rational) {
        float w = 1.0 / value.w;
        jet.point = value.xyz * w;
        jet.du = (c.slope.xyz - jet.point * c.slope.w) * w;
        jet.dv = (across.xyz - jet.point * across.w) * w;
    } else {
        jet.point = value.xyz;
        jet.du = c.slope.xyz;
        jet.dv = across.xyz;
    }
    return jet;
}

// At (u, v), (u + apart.x, v) and (u, v + apart.y).
void jets_beside(uint first, uint shape, vec3 base, vec2 uv, vec2 apart, out Jet jets[3]) {
    uint n = degree_u(shape);
    uint k = degree_v(shape);
    vec2 u = vec2(uv.x, uv.x + apart.x);
    vec2 v = vec2(uv.y, uv.y + apart.y);
    const Sums NONE = Sums(vec4(0.0), vec4(0.0), vec4(0.0));
    Sums at = NONE;
    Sums along_u = NONE;
    Sums along_v = NONE;
    Weights w[2] = Weights[](Weights(1.0, 1.0), Weights(1.0, 1.0)); // of both v
    Weights wide[2] = w;
    vec2 before = vec2(0.0);
    for (uint j = 0u; j <= k; ++j) {
        int row = int(first + j * (n + 1u));
        vec4 a0 = vec4(0.0);
        vec4 b0 = vec4(0.0);
        vec4 a1 = vec4(0.0);
        vec4 b1 = vec4(0.0);
        Weights w0 = Weights(1.0, 1.0);
        Weights w1 = w0;
        float before0 = 0.0;
        float before1 = 0.0;
        for (uint i = 0u; i <= n; ++i) {
            vec4 p = control_point(row + int(i), base);
            put_row(a0, b0, w0, before0, p, i, n, u.x);
            put_row(a1, b1, w1, before1, p, i, n, u.y);
        }
        vec4 value = a0 * (1.0 - u.x) + b0 * u.x;
        vec4 slope = (b0 - a0) * float(n);
        put_column(at, value, slope, before.x, w[0], wide[0], j < k, 1.0 - v.x);
        put_column(along_v, value, slope, before.y, w[1], wide[1], j < k, 1.0 - v.y);
        value = a1 * (1.0 - u.y) + b1 * u.y;
        slope = (b1 - a1) * float(n);
        put_column(along_u, value, slope, before.x, w[0], wide[0], j < k, 1.0 - v.x);
        before = vec2(weight_of(w[0]), weight_of(w[1]));
        for (uint i = 0u; i < 2u; ++i) {
            advance(w[i], k - 1u, j, v[i]);
            advance(wide[i], k, j, v[i]);
        }
    }
    bool rational = SCENE_HAS_RATIONAL && is_rational(shape);
    jets[0] = jet_of(at, k, v.x, rational);
    jets[1] = jet_of(along_u, k, v.x, rational);
    jets[2] = jet_of(along_v, k, v.y, rational);
}

#endif
