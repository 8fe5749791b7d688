// The result of pass `resolve` in a pixel, for passes that mix it with its neighbours. Needs `frame`, `resolved` and
// shade.glsl.
#ifndef UNMIXED_GLSL
#define UNMIXED_GLSL

#include "in_picture.glsl"

// Linear, multiplied by its opacity.
vec4 unmixed(vec4 seen) {
    if (seen.a < UNSEEN) return vec4(seen.rgb, 1.0);
    float opacity = max(frame.background.a, 0.0);
    return vec4(frame.background.rgb * opacity, opacity);
}

// The same of what later passes made of it: in mixed pixels, colour times opacity and the negative opacity.
vec4 shown(vec4 seen) { return seen.a < 0.0 ? vec4(seen.rgb, -seen.a) : unmixed(seen); }

vec4 unmixed_at(ivec2 at) { return unmixed(imageLoad(resolved, at)); }

#endif
