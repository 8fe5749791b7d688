// The ray through a pixel's sample, relative to the eye: points o + t d at depth t along the view axis.
#ifndef EYE_RAY_GLSL
#define EYE_RAY_GLSL

struct Ray {
    vec3 o;
    vec3 d;
};

Ray eye_ray(Frame frame, vec2 pixel) {
    // the same bits in every pass
    precise vec2 p = (pixel + frame.offset - frame.principal_px) / frame.focal_px;
    precise vec3 across = p.x * frame.right - p.y * frame.up;
    precise vec3 ahead = frame.forward + across;
    if (frame.perspective != 0u) return Ray(vec3(0.0), ahead);
    return Ray(across, frame.forward);
}

#endif
