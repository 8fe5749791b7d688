// A pixel's colour as a mean of linear ones, into the host's target. Needs `frame` and scene.glsl.
#ifndef MEAN_GLSL
#define MEAN_GLSL

#include "shade.glsl"

layout(location = 0) out vec4 out_colour; // multiplied by its opacity where the host keeps its picture

// In alpha of opacities; where the host keeps its picture, colours are multiplied by theirs, and what saw nothing
// lets it through.
void write_mean(vec4 mean) {
    out_colour = encode(mean, frame.encode_srgb);
    if (frame.background.a >= 0.0) return;
    if (mean.a == 0.0) discard;
    out_colour = vec4(encode(mean / mean.a, frame.encode_srgb).rgb * mean.a, mean.a);
}

#endif
