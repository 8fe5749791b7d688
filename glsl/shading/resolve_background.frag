#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`, the background of samples without a surface, unless the host's picture stays. Samples are added up,
// so the background must not be in the sum for other samples.
#include "scene.glsl"
#include "view.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 2, rg32ui) readonly uniform uimage2D meshes_and_solids; // without trims, the same image

#include "shade.glsl"
#include "visible.glsl"

layout(location = 0) out vec4 out_colour;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    if (!sees_nothing(imageLoad(visibility, pixel).x) || !sees_nothing(imageLoad(meshes_and_solids, pixel).x)) discard;
    if (frame.background.a < 0.0) discard;
    out_colour = encode(frame.background, frame.encode_srgb);
    out_colour.rgb *= frame.background.a;
    gl_FragDepth = 0.0;
}
