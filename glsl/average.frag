#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `average`: the mean of a pixel's samples. Where the host keeps its picture, samples that saw
// nothing let it through.
#include "scene.glsl"
#include "shade.glsl"

layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(binding = 1, rgba16f) readonly uniform image2D sum; // linear; of opacities in alpha

layout(location = 0) out vec4 out_colour; // multiplied by its opacity where the host keeps its picture

void main() {
    vec4 mean = imageLoad(sum, ivec2(gl_FragCoord.xy)) / float(frame.samples);
    out_colour = encode(mean, frame.encode_srgb);
    if (frame.background.a >= 0.0) return;
    if (mean.a == 0.0) discard;
    out_colour = vec4(encode(mean / mean.a, frame.encode_srgb).rgb * mean.a, mean.a);
}
