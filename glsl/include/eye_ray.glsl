// The ray through a pixel's sample, seen from the eye: points o + t d at depth t along the view axis.
#ifndef EYE_RAY_GLSL
#define EYE_RAY_GLSL

struct Ray {
    vec3 o;
    vec3 d;
};

Ray eye_ray(Frame frame, vec2 pixel) {
    // in every pass the same bits
    precise vec2 p = (pixel + frame.offset - frame.principal_px) / frame.focal_px;
    precise vec3 across = p.x * frame.right - p.y * frame.up;
    precise vec3 ahead = frame.forward + across;
    if (frame.perspective != 0u) return Ray(vec3(0.0), ahead);
    return Ray(across, frame.forward);
}

#endif
