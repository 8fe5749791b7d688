// Writes a pixel's colour, as a mean of linear colours, to the host's target. Needs `frame` and scene.glsl.
#ifndef MEAN_GLSL
#define MEAN_GLSL

#include "shade.glsl"

layout(location = 0) out vec4 out_colour; // multiplied by its opacity if the host's picture stays

// `mean`: colours times their opacities, and the mean opacity. If the host's picture stays, it shows through the rest.
void write_mean(vec4 mean) {
    bool keeps = frame.background.a < 0.0;
    if (keeps && mean.a == 0.0) discard;
    float opacity = frame.background.a >= 1.0 || mean.a == 0.0 ? 1.0 : mean.a;
    vec3 colour = encode(mean / opacity, frame.encode_srgb).rgb;
    out_colour = vec4(keeps ? colour * mean.a : colour, mean.a);
}

#endif
