#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `blister`: draws the locked faces among all other surfaces.
#include "scene.glsl"
#include "view.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rg32ui) readonly uniform uimage2D found;
layout(location = 0) out uvec2 visible;

void main() {
    visible = imageLoad(found, ivec2(gl_FragCoord.xy)).xy;
    if (visible.x == 0u) discard;
    float t = uintBitsToFloat(visible.y);
    gl_FragDepth = reversed_depth(frame, t) / (frame.perspective != 0u ? t : 1.0);
}
