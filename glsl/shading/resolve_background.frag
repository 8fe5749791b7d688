#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`, the background of a pixel's samples, where one sees nothing, unless the host keeps its picture. They
// are added up, so it may not lie below what is seen.
#include "scene.glsl"
#include "view.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 2, rg32ui) readonly uniform uimage2D others; // in scenes without trims the same

#include "shade.glsl"
#include "visible.glsl"

layout(location = 0) out vec4 out_colour;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (!sees_nothing(imageLoad(visibility, pixel).x) || !sees_nothing(imageLoad(others, pixel).x)) discard;
    if (frame.background.a < 0.0) discard;
    out_colour = encode(frame.background, frame.encode_srgb);
    out_colour.rgb *= frame.background.a;
    gl_FragDepth = 0.0;
}
