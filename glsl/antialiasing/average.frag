#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `average`: the mean of a pixel's samples. Where the host keeps its picture, samples that saw
// nothing let it through.
#include "scene.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rgba16f) readonly uniform image2D sum; // linear; of opacities in alpha

#include "mean.glsl"

void main() {
    write_mean(imageLoad(sum, ivec2(gl_FragCoord.xy)) / float(frame.samples));
}
