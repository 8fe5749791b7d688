// From part coordinates to the picture. Twin of src/twin/view.rs.
//
// Each placed part has four rows (X, Y, D, W): pixel = (X, Y) / W, D = depth along the view axis.
#ifndef VIEW_GLSL
#define VIEW_GLSL

struct View {
    vec4 x;
    vec4 y;
    vec4 depth;
    vec4 w;
};

vec4 to_pixel(View view, vec4 p) {
    return vec4(dot(view.x, p), dot(view.y, p), dot(view.depth, p), dot(view.w, p));
}

// The smallest W of the box in front of the near plane, or a negative number when no part of the
// box can be seen. `margin` widens the picture, in pixels.
float visible_w(View view, Frame frame, vec3 lo, vec3 hi, float margin) {
    float w_min = 3.0e38;
    uint outside = 63u;
    for (uint i = 0u; i < 8u; ++i) {
        vec3 c = vec3((i & 1u) == 0u ? lo.x : hi.x, (i & 2u) == 0u ? lo.y : hi.y, (i & 4u) == 0u ? lo.z : hi.z);
        vec4 q = to_pixel(view, vec4(c, 1.0));
        w_min = min(w_min, q.w);
        uint here = 0u;
        here |= q.x + margin * q.w < 0.0 ? 1u : 0u;
        here |= q.x - (frame.size.x + margin) * q.w > 0.0 ? 2u : 0u;
        here |= q.y + margin * q.w < 0.0 ? 4u : 0u;
        here |= q.y - (frame.size.y + margin) * q.w > 0.0 ? 8u : 0u;
        here |= q.z < frame.near ? 16u : 0u;
        here |= q.z > frame.far ? 32u : 0u;
        outside &= here;
    }
    if (outside != 0u) return -1.0;
    return frame.perspective != 0u ? max(w_min, frame.near) : 1.0;
}

// Pixels that one part unit can cover at homogeneous weight w.
float pixels_per_unit(Frame frame, Instance instance, float w) {
    return frame.focal * frame.slant * instance.scale / w;
}

#endif
