// Trim curves in the normalised (u, v) domain. Twin of src/twin/curve.rs.
// Needs `samplerBuffer curve_points`, three numbers a control point.
#ifndef CURVE_GLSL
#define CURVE_GLSL

#include "words.glsl"

vec3 curve_control(Curve curve, uint i) {
    return numbers_at(curve_points, curve.first + 3u * i);
}

// Point `i` of `n` equal steps. The ends are the stored ones, so curves of a loop share them bit for bit. Inner points
// depend only on (curve, i, n), so segments share theirs.
vec2 curve_point(Curve curve, uint i, uint n) {
    if (i == 0u) return curve.start;
    if (i >= n) return curve.end;
    precise float t = float(i) / float(n);
    precise float s = 1.0 - t;
    if (curve.degree == 1u) {
        precise vec2 p = curve.start * s + curve.end * t;
        return p;
    }
    precise float f = 1.0;
    precise float c = 1.0;
    precise vec3 sum = curve_control(curve, 0u) * s;
    for (uint k = 1u; k < curve.degree; ++k) {
        f = f * t;
        c = c * (float(curve.degree - k + 1u) / float(k));
        sum = (sum + curve_control(curve, k) * (f * c)) * s;
    }
    sum = sum + curve_control(curve, curve.degree) * (f * t);
    precise vec2 p = sum.xy / sum.z;
    return p;
}

#endif
