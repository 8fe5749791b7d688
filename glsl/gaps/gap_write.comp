#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `heal`, last step: what the second found is seen. A step of its own, since that asks a pixel's neighbours for
// what was drawn there. One thread a doubtful pixel.
#include "scene.glsl"
#include "visible.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rg32ui) writeonly uniform uimage2D visibility;
layout(scalar, binding = 2) readonly buffer Doubts { Doubt doubts[]; };
layout(scalar, binding = 3) readonly buffer CountersBuffer { Counters counters; };

void main() {
    uint n = gl_GlobalInvocationID.x;
    if (n >= min(counters.doubts, frame.doubt_capacity)) return;
    imageStore(visibility, doubtful_pixel(doubts[n].pixel), uvec4(doubts[n].healed, 0u, 0u));
}
