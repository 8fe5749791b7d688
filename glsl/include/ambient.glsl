// Points that pixels see, for pass `ambient`. Needs scene.glsl, view.glsl, `frame` and `float depth_at(ivec2)`, which is UNSEEN
// where nothing is seen.
#ifndef AMBIENT_GLSL
#define AMBIENT_GLSL

#include "eye_ray.glsl"

bool in_picture(ivec2 at) { return all(greaterThanEqual(at, ivec2(0))) && all(lessThan(at, ivec2(frame.size))); }

// Depth of a pixel; UNSEEN beside the picture.
float depth_beside(ivec2 at) { return in_picture(at) ? depth_at(at) : UNSEEN; }

// The point that a pixel sees, in model axes.
vec3 point_at(ivec2 at, float depth) {
    Ray ray = eye_ray(frame, vec2(at) + 0.5);
    return ray.o + depth * ray.d;
}

// What is linear in the picture along a plane.
float linear_depth(float depth) { return frame.perspective != 0u ? 1.0 / depth : depth; }

// How far two pixels in a row are from the plane that goes on through a third; UNSEEN where the first sees nothing.
float bend(ivec2 at, ivec2 axis, float here) {
    float first = depth_beside(at + axis);
    float second = depth_beside(at + 2 * axis);
    if (first >= UNSEEN) return UNSEEN;
    float step_ = linear_depth(first) - here;
    return abs(second >= UNSEEN ? step_ : linear_depth(second) - linear_depth(first) - step_);
}

// On which side of a pixel, along an axis, its surface goes on: 1 or -1; 0 where nothing is seen on either.
int like_beside(ivec2 at, ivec2 axis, float depth) {
    float here = linear_depth(depth);
    float after = bend(at, axis, here);
    float before = bend(at, -axis, here);
    if (min(after, before) >= UNSEEN) return 0;
    return after <= before ? 1 : -1;
}

#endif
