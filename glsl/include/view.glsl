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

// A dot product whose rounding is fixed: every pipeline that draws a shared vertex gets the same
// bits, and so does the twin.
float row_times(vec4 row, vec4 p) {
    precise float sum = row.x * p.x + row.y * p.y + row.z * p.z + row.w * p.w;
    return sum;
}

vec4 to_pixel(View view, vec4 p) {
    return vec4(row_times(view.x, p), row_times(view.y, p), row_times(view.depth, p), row_times(view.w, p));
}

// Reversed depth in a perspective view times `w`, in a parallel one as it is: 1 at the near plane, 0 at
// the far one. Floats are densest near 0, where perspective needs them.
float reversed_depth(Frame frame, float depth) {
    float range = 1.0 / (frame.far - frame.near);
    return (frame.far - depth) * range * (frame.perspective != 0u ? frame.near : 1.0);
}

// What the rasteriser wants of a homogeneous pixel.
vec4 to_clip(Frame frame, vec4 q) {
    return vec4(q.xy * 2.0 / frame.size - q.w, reversed_depth(frame, q.z), q.w);
}

// In a parallel view depth runs on beyond the far plane, to this many times its distance from the near one.
const float RUN = 16.0;

// The same where nothing is cut off at the far plane.
vec4 to_clip_unending(Frame frame, vec4 q) {
    float z = frame.perspective != 0u ? frame.near : 1.0 - (q.z - frame.near) / (RUN * (frame.far - frame.near));
    return vec4(q.xy * 2.0 / frame.size - q.w, z, q.w);
}

// The smallest W of the box in front of the near plane, or a negative number when no part of the
// box can be seen. `margin` widens the picture, in pixels; `far` is the far plane's depth.
float visible_w(View view, Frame frame, vec3 lo, vec3 hi, float margin, float far) {
    float w_min = 3.0e38;
    uint outside = 63u;
    for (uint i = 0u; i < 8u; ++i) {
        vec3 c = vec3((i & 1u) == 0u ? lo.x : hi.x, (i & 2u) == 0u ? lo.y : hi.y, (i & 4u) == 0u ? lo.z : hi.z);
        vec4 q = to_pixel(view, vec4(c, 1.0));
        w_min = min(w_min, q.w);
        precise vec2 low = q.xy + margin * q.w;                  // negative left of and above the picture
        precise vec2 high = q.xy - (frame.size + margin) * q.w;  // positive right of and below it
        uint here = 0u;
        here |= low.x < 0.0 ? 1u : 0u;
        here |= high.x > 0.0 ? 2u : 0u;
        here |= low.y < 0.0 ? 4u : 0u;
        here |= high.y > 0.0 ? 8u : 0u;
        here |= q.z < frame.near ? 16u : 0u;
        here |= q.z > far ? 32u : 0u;
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
