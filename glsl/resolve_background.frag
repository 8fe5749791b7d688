#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`, the background: where nothing is seen. Samples are added up, so it may not lie below what is.
#include "scene.glsl"
#include "view.glsl"

layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(binding = 1, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 2, rg32ui) readonly uniform uimage2D others; // in scenes without trims the same

#include "resolved.glsl"
#include "visible.glsl"

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (!sees_nothing(imageLoad(visibility, pixel).x) || !sees_nothing(imageLoad(others, pixel).x)) discard;
    write_nothing();
}
