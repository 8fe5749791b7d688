// How far a sheet's terms of second order reach, for pass `border_mix`, and where a face's surface goes on beyond the
// ends of its domain, for pass `border_follow`, too. Needs scene.glsl. Twin: src/twin/border_reach.rs, which has the
// derivation.
//
//     q(u, v) - terms  ≈  u² (|u| + 3 h / 2) q_uuu / 6  +  v² (|v| + 3 h / 2) q_vvv / 6  +  |u v| (|u| + |v|) q_uv_ / 2
//
//     h  ASIDE: the second derivatives are differences over so much of the patch
#ifndef BORDER_REACH_GLSL
#define BORDER_REACH_GLSL

// From the middle to where the derivatives are taken again, of the patch.
const float ASIDE = 0.015625;
// Most that the terms of second order may be off at a point, in pixels. What they leave out grows with the cube of the
// way, so it is less than a tenth of this over half of the way. Sixteen points are as far off on their own; a tip is as
// thin as twice as much.
const float REMAINDER_PX = 0.125;
// From the middle of a patch, of the patch: the surface beyond the patches beside it is another one.
const float MOST_FROM_MIDDLE = 1.5;

// A change of a homogeneous pixel, in pixels.
vec2 pixels_of(vec4 q, vec4 change) {
    precise vec2 at = q.xy / q.w;
    precise vec2 moved = change.xy - at * change.w;
    precise vec2 px = moved / q.w;
    return px;
}

// Factors of `remainder_px` along u and v, and across: `end_u` and `end_v` are the ways of the homogeneous pixel over
// ASIDE less what the derivatives at both ends say, `twist` the difference of the two mixed derivatives.
vec3 third_order(vec4 q, vec4 end_u, vec4 end_v, vec4 twist) {
    vec2 u = pixels_of(q, end_u);
    vec2 v = pixels_of(q, end_v);
    vec2 t = pixels_of(q, twist);
    precise vec3 squares = vec3(u.x * u.x + u.y * u.y, v.x * v.x + v.y * v.y, t.x * t.x + t.y * t.y);
    precise vec3 sizes = sqrt(squares);
    precise vec3 third = sizes * vec3(2.0 / (ASIDE * ASIDE * ASIDE), 2.0 / (ASIDE * ASIDE * ASIDE), 1.0 / ASIDE);
    return third;
}

// What the terms of second order leave out on the way to (u, v) from the middle, in pixels.
float remainder_px(vec3 third, vec2 uv) {
    vec2 far = abs(uv);
    precise vec2 alone = far * far * (far + 1.5 * ASIDE);
    precise float both = far.x * far.y * (far.x + far.y);
    precise float left = third.x * alone.x + third.y * alone.y + third.z * both;
    return left;
}

// Whether the terms of second order hold at (u, v) from the middle, which is at `middle` of the patch.
bool is_in_reach(vec3 third, vec2 middle, vec2 uv) {
    precise vec2 beside = abs(middle + uv - 0.5);
    return remainder_px(third, uv) <= REMAINDER_PX && max(beside.x, beside.y) <= MOST_FROM_MIDDLE;
}

// Of a place beyond the domain of a face whose sides meet there: the same place, over the seam.
vec2 over_seams(uint flags, vec2 at) {
    bool u = (flags & FACE_MEETS_U) != 0u && (at.x < 0.0 || at.x > 1.0);
    bool v = (flags & FACE_MEETS_V) != 0u && (at.y < 0.0 || at.y > 1.0);
    precise vec2 turned = at - floor(at);
    return vec2(u ? turned.x : at.x, v ? turned.y : at.y);
}

// Whether a place lies beyond a side of the face's surface that is a point.
bool is_over_pole(uint flags, vec2 at) {
    uint sides = (at.x < 0.0 ? BORDER_U0 : 0u) | (at.x > 1.0 ? BORDER_U1 : 0u);
    sides |= (at.y < 0.0 ? BORDER_V0 : 0u) | (at.y > 1.0 ? BORDER_V1 : 0u);
    return ((flags >> FACE_POINTS) & sides) != 0u;
}

#endif
