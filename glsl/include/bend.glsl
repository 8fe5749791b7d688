// Curvature of patches: second derivatives by de Casteljau's algorithm, which stops at three points here.
//
//        a ───── b ───── c     value  s² a + 2 s t b + t² c           s = 1 - t, degree m
//                              slope  m ((b - a) s + (c - b) t)
//                              bend   m (m - 1) (a - 2 b + c)
//
// Needs patch.glsl, refine.glsl, view.glsl and curvature.glsl. Twin: `Jet2` of the geometry.
#ifndef BEND_GLSL
#define BEND_GLSL

// The last three points of a row.
struct Three {
    vec4 a;
    vec4 b;
    vec4 c;
};

const Three NO_POINTS = Three(vec4(0.0), vec4(0.0), vec4(0.0));

vec4 value_of(Three p, float t) { return mix(mix(p.a, p.b, t), mix(p.b, p.c, t), t); }
vec4 slope_of(Three p, uint m, float t) { return mix(p.b - p.a, p.c - p.b, t) * float(m); }
vec4 bend_of(Three p, uint m) { return (p.a - 2.0 * p.b + p.c) * float(m * (m - 1u)); }

// Horner's scheme for three points at once: control point `i` of degree `m`; `weights` are those of degree m - 2 of i, of
// the control point before and of the one before that.
void put(inout Three p, vec4 point, uint i, uint m, vec3 weights, float t) {
    float s = 1.0 - t;
    if (i + 2u <= m) p.a = p.a * s + point * weights.x;
    if (i + 1u <= m) p.b = p.b * s + point * weights.y;
    p.c = p.c * s + point * weights.z;
}

// Lines are parabolas, too: the control point in the middle is the mean.
uint raised(uint degree) { return max(degree, 2u); }

vec4 raised_point(uint first, uint n, uint i, vec3 base) {
    if (n > 1u) return control_point(int(first + i), base);
    return mix(control_point(int(first), base), control_point(int(first) + 1, base), 0.5 * float(i));
}

Three three_of_row(uint first, uint n, vec3 base, float u) {
    uint m = raised(n);
    Three row = NO_POINTS;
    Weights w = Weights(1.0, 1.0);
    vec3 weights = vec3(0.0);
    for (uint i = 0u; i <= m; ++i) {
        weights = vec3(i + 2u <= m ? weight_of(w) : 0.0, weights.xy);
        put(row, raised_point(first, n, i, base), i, m, weights, u);
        advance(w, m - 2u, i, u);
    }
    return row;
}

// Derivatives of the homogeneous patch up to the second.
struct Bend {
    vec4 point;
    vec4 du;
    vec4 dv;
    vec4 duu;
    vec4 duv;
    vec4 dvv;
};

Bend bend_at(uint first, uint shape, vec3 base, vec2 uv) {
    uint n = degree_u(shape);
    uint k = degree_v(shape);
    uint m = raised(k);
    Three values = NO_POINTS;
    Three slopes = NO_POINTS;
    Three bends = NO_POINTS;
    Weights w = Weights(1.0, 1.0);
    vec3 weights = vec3(0.0);
    for (uint j = 0u; j <= m; ++j) {
        // the mean of two rows, as in `raised_point`
        uint lower = k > 1u ? j : j / 2u;
        uint upper = k > 1u ? j : (j + 1u) / 2u;
        Three row = three_of_row(first + lower * (n + 1u), n, base, uv.x);
        Three other = three_of_row(first + upper * (n + 1u), n, base, uv.x);
        row = Three(mix(row.a, other.a, 0.5), mix(row.b, other.b, 0.5), mix(row.c, other.c, 0.5));
        weights = vec3(j + 2u <= m ? weight_of(w) : 0.0, weights.xy);
        put(values, value_of(row, uv.x), j, m, weights, uv.y);
        put(slopes, slope_of(row, raised(n), uv.x), j, m, weights, uv.y);
        put(bends, bend_of(row, raised(n)), j, m, weights, uv.y);
        advance(w, m - 2u, j, uv.y);
    }
    return Bend(
        value_of(values, uv.y), value_of(slopes, uv.y), slope_of(values, m, uv.y), value_of(bends, uv.y),
        slope_of(slopes, m, uv.y), bend_of(values, m)
    );
}

// A direction of the part along the camera's axes, in model units: right, down, forward.
vec3 along_axes(View view, vec3 direction) {
    vec4 q = to_pixel(view, vec4(direction, 0.0));
    return vec3((q.xy - frame.principal_px * q.w) / frame.focal_px, q.z);
}

// Curvature of a part's surface in the model, which may stretch the part: derivatives are along the camera's axes. The
// mean is above 0 where the surface bends away from S_u x S_v.
Curvature patch_curvature(Patch patch_, View view, Sample s) {
    Net net = net_of(patch_);
    Bend b = bend_at(net.first, patch_.shape, net.less, s.uv);
    // quotient rule
    float weight = 1.0 / b.point.w;
    vec3 p = b.point.xyz * weight;
    vec3 u = (b.du.xyz - p * b.du.w) * weight;
    vec3 v = (b.dv.xyz - p * b.dv.w) * weight;
    vec3 uu = along_axes(view, (b.duu.xyz - 2.0 * b.du.w * u - p * b.duu.w) * weight);
    vec3 uv = along_axes(view, (b.duv.xyz - b.du.w * v - b.dv.w * u - p * b.duv.w) * weight);
    vec3 vv = along_axes(view, (b.dvv.xyz - 2.0 * b.dv.w * v - p * b.dvv.w) * weight);
    u = along_axes(view, u);
    v = along_axes(view, v);
    vec3 n = cross(u, v);
    float area = dot(n, n);
    if (!(area > 0.0)) return NO_CURVATURE; // a pole
    n = normalize(n);
    float l = -dot(uu, n);
    float m = -dot(uv, n);
    float k = -dot(vv, n);
    float mean = 0.5 * (dot(u, u) * k - 2.0 * dot(u, v) * m + dot(v, v) * l) / area;
    return Curvature(mean, (l * k - m * m) / area);
}

#endif
