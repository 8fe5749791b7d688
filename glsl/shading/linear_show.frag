#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `linear_show`: writes the linear colours of pass `resolve`, as later passes have changed them, to the host's
// colour.
#include "scene.glsl"
#include "view.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rgba32f) readonly uniform image2D resolved;

#include "mean.glsl"
#include "unmixed.glsl"

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    write_mean(shown(imageLoad(resolved, at)));
}
