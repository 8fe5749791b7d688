// The ray through a pixel, seen from the eye: points o + t d at depth t along the view axis.
#ifndef EYE_RAY_GLSL
#define EYE_RAY_GLSL

struct Ray {
    vec3 o;
    vec3 d;
};

Ray eye_ray(Frame frame, vec2 pixel) {
    vec2 p = (pixel - 0.5 * frame.size) / frame.focal;
    vec3 across = p.x * frame.right - p.y * frame.up;
    if (frame.perspective != 0u) return Ray(vec3(0.0), frame.forward + across);
    return Ray(across, frame.forward);
}

#endif
