#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `bound`: finds the patches that may be visible, and bounds how finely each must be divided. One thread for each
// listed patch instance. Twin: src/twin/bound.rs.
#include "bound.glsl"
#include "factor.glsl"

// Where a bend towards the eye moves no pixel, points may deviate in space by this factor more than pixels.
const float DEPTH_SHARE = 1.5;

vec4 control_point(Patch patch_, uvec2 at) {
    return texelFetch(points, int(patch_.first + at.y * (degree_u(patch_.shape) + 1u) + at.x));
}

// Shrinks `seen`, the projection of the patch's box, to the control points, whose hull contains the patch. False if a
// control point is before the near plane.
bool draw_closer(Patch patch_, View view, inout Seen seen) {
    uint count = (degree_u(patch_.shape) + 1u) * (degree_v(patch_.shape) + 1u);
    float w = 3.0e38;
    float steepest = 0.0; // squared slope
    vec2 low = vec2(3.0e38);
    vec2 high = vec2(-3.0e38);
    for (uint i = 0u; i < count; ++i) {
        vec4 p = texelFetch(points, int(patch_.first + i));
        vec4 q = to_pixel(view, p);
        precise float depth = q.w / p.w;
        w = min(w, depth);
        precise vec2 pixel = q.xy / q.w;
        low = min(low, pixel);
        high = max(high, pixel);
        precise vec2 slope = (pixel - frame.principal_px) / frame.focal_px;
        precise float slope2 = slope.x * slope.x + slope.y * slope.y;
        steepest = max(steepest, slope2);
    }
    if (frame.perspective == 0u) {
        seen = Seen(1.0, 1.0, low, high);
        return true;
    }
    if (!(w >= frame.near)) return false;
    precise float slant = sqrt(1.0 + steepest);
    seen = Seen(max(w, seen.w), min(slant, seen.slant), low, high);
    return true;
}

// Pixels by which an offset `d`, part units, moves a point, times W: the largest over pixels from `low` to `high`.
float moves(View view, vec3 d, vec2 low, vec2 high) {
    vec4 q = to_pixel(view, vec4(d, 0.0));
    precise vec2 at_low = q.xy - low * q.w;
    precise vec2 at_high = q.xy - high * q.w;
    vec2 most = max(abs(at_low), abs(at_high)); // each is linear, and so is the other
    precise float length2 = most.x * most.x + most.y * most.y;
    return sqrt(length2);
}

// Like Patch.bend, for the movement of pixels of a polynomial patch, times W.
vec3 bend_seen(Patch patch_, View view, vec2 low, vec2 high) {
    uint n = degree_u(patch_.shape);
    uint k = degree_v(patch_.shape);
    vec3 times = vec3(n * (n - 1u), n * k, k * (k - 1u));
    vec3 most = vec3(0.0);
    for (uint j = 0u; j <= k; ++j) {
        for (uint i = 0u; i <= n; ++i) {
            uvec2 one = min(uvec2(i, j) + 1u, uvec2(n, k));
            uvec2 two = min(uvec2(i, j) + 2u, uvec2(n, k));
            vec3 p = control_point(patch_, uvec2(i, j)).xyz;
            vec3 pu = control_point(patch_, uvec2(one.x, j)).xyz;
            vec3 pv = control_point(patch_, uvec2(i, one.y)).xyz;
            precise vec3 uu = (control_point(patch_, uvec2(two.x, j)).xyz - pu) - (pu - p);
            precise vec3 uv = (control_point(patch_, one).xyz - pv) - (pu - p);
            precise vec3 vv = (control_point(patch_, uvec2(i, two.y)).xyz - pv) - (pv - p);
            if (i + 2u <= n) most.x = max(most.x, moves(view, uu, low, high));
            most.y = max(most.y, moves(view, uv, low, high));
            if (j + 2u <= k) most.z = max(most.z, moves(view, vv, low, high));
        }
    }
    precise vec3 bend = most * times;
    return bend;
}

vec2 factors_of(Patch patch_, View view, uint instance, Seen seen) {
    if (patch_.bend == vec3(0.0)) return vec2(1.0);
    float budget = 8.0 * frame.deviation_px;
    // the control points are within the box and need no more segments: those of a small patch are not read
    precise vec3 of_box = patch_.bend * pixels_per_unit(frame, instances[instance], seen);
    if (is_undivided(of_box, budget)) return vec2(1.0);
    bool whole = draw_closer(patch_, view, seen);
    precise vec3 bend = patch_.bend * pixels_per_unit(frame, instances[instance], seen);
    vec2 tau = factors(bend, budget);
    if (!whole || is_rational(patch_.shape) || tau == vec2(1.0)) return tau;
    vec2 low = clamp(seen.low, vec2(0.0), frame.size);
    vec2 high = clamp(seen.high, vec2(0.0), frame.size);
    precise vec3 across = bend_seen(patch_, view, low, high) / seen.w;
    precise vec3 in_depth = bend / DEPTH_SHARE;
    vec2 fewer = factors(max(across, in_depth), budget);
    return fewer.x * fewer.y < tau.x * tau.y ? fewer : tau;
}
