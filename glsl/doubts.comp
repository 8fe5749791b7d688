#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `heal`, first step: the list of doubtful pixels. One thread a pixel.
#include "scene.glsl"
#include "visible.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(binding = 1, rg32ui) readonly uniform uimage2D visibility;
layout(scalar, binding = 2) writeonly buffer Doubts { uint doubts[]; }; // column | row << 16
layout(scalar, binding = 3) buffer Dispatch { uvec3 dispatch; }; // of the second step; zero before
layout(scalar, binding = 4) buffer CountersBuffer { Counters counters; };

const uint GROUP = 64u; // threads of a workgroup of the second step

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= uint(frame.size.x)) return;
    if ((imageLoad(visibility, ivec2(pixel)).x & DOUBTFUL) == 0u) return;
    uint at = atomicAdd(counters.doubts, 1u);
    if (at >= frame.doubt_capacity) {
        atomicOr(counters.failed, FAILED_DOUBTS);
        return;
    }
    doubts[at] = pixel.x | pixel.y << 16;
    atomicMax(dispatch.x, at / GROUP + 1u);
    atomicMax(dispatch.y, 1u);
    atomicMax(dispatch.z, 1u);
}
