// The points visible in pixels, and the surfaces that they lie on, for passes `ambient_find` and `ambient_write`. Needs
// scene.glsl, view.glsl, `frame`, and `float depth_at(ivec2)`, which returns UNSEEN for a pixel of the background.
#ifndef AMBIENT_GLSL
#define AMBIENT_GLSL

#include "in_picture.glsl"

// Depth of a pixel; UNSEEN outside the picture.
float depth_beside(ivec2 at) { return is_in_picture(at) ? depth_at(at) : UNSEEN; }

// The point visible in a pixel, relative to the eye: to the right, down, along the view axis.
vec3 point_at(ivec2 at, float depth) {
    vec2 across = (vec2(at) + 0.5 + frame.offset - frame.principal_px) / frame.focal_px;
    return vec3(frame.perspective != 0u ? depth * across : across, depth);
}

// A function of the depth that is linear in the picture along a plane.
float linear_depth(float depth) { return frame.perspective != 0u ? 1.0 / depth : depth; }

// Distance of the second neighbour along an axis from the line through this pixel and the first, in linear depth. If
// the second is background: distance of the first from this pixel. If the first is background: UNSEEN.
float bend(ivec2 at, ivec2 axis, float here) {
    float first = depth_beside(at + axis);
    float second = depth_beside(at + 2 * axis);
    if (first >= UNSEEN) return UNSEEN;
    float step_ = linear_depth(first) - here;
    return abs(second >= UNSEEN ? step_ : linear_depth(second) - linear_depth(first) - step_);
}

// The side of a pixel, along an axis, on which its surface continues: 1 or -1; 0 if both neighbours are background.
int like_beside(ivec2 at, ivec2 axis, float depth) {
    float here = linear_depth(depth);
    float after = bend(at, axis, here);
    float before = bend(at, -axis, here);
    if (min(after, before) >= UNSEEN) return 0;
    return after <= before ? 1 : -1;
}

#endif
