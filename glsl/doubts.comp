#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `heal`, first step: the list of doubtful pixels: what is seen is doubtful itself, or a ring lies
// before it, or nothing is seen between patches. All of them get the mark. One thread a pixel.
#include "scene.glsl"
#include "visible.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rg32ui) uniform uimage2D visibility;
layout(scalar, binding = 2) writeonly buffer Doubts { uint doubts[]; }; // column | row << 16 | RINGED | LONE
layout(scalar, binding = 3) buffer Dispatch { uvec3 dispatch; }; // of the second step; zero before
layout(scalar, binding = 4) buffer CountersBuffer { Counters counters; };
layout(binding = 5) uniform sampler2D depth; // reversed
layout(scalar, binding = 6) readonly buffer Rings { uint rings[]; };

const uint GROUP = 64u; // threads of a workgroup of the second step

// Whether nothing is seen between patches on both sides. Their marks may come meanwhile: they are not asked for.
bool lone(uint word, ivec2 pixel) {
    if (!sees_nothing(word)) return false;
    for (uint k = 0u; k < 4u; ++k) {
        ivec2 step_ = ivec2[](ivec2(1, 0), ivec2(0, 1), ivec2(1, 1), ivec2(1, -1))[k];
        ivec2 a = pixel - step_;
        ivec2 b = pixel + step_;
        if (any(lessThan(min(a, b), ivec2(0))) || any(greaterThanEqual(max(a, b), ivec2(frame.size)))) continue;
        if (!sees_nothing(imageLoad(visibility, a).x) && !sees_nothing(imageLoad(visibility, b).x)) return true;
    }
    return false;
}

void main() {
    uvec2 pixel = gl_GlobalInvocationID.xy;
    if (pixel.x >= uint(frame.size.x)) return;
    uvec2 seen = imageLoad(visibility, ivec2(pixel)).xy;
    uint flags = 0u;
    if ((seen.x & DOUBTFUL) == 0u) {
        float ring = uintBitsToFloat(rings[pixel.y * uint(frame.size.x) + pixel.x]);
        flags = RINGED;
        if (!(ring > texelFetch(depth, ivec2(pixel), 0).x)) {
            if (!lone(seen.x, ivec2(pixel))) return;
            flags |= LONE;
        }
        imageStore(visibility, ivec2(pixel), uvec4(seen.x | DOUBTFUL, seen.y, 0u, 0u));
    }
    uint at = atomicAdd(counters.doubts, 1u);
    if (at >= frame.doubt_capacity) {
        atomicOr(counters.failed, FAILED_DOUBTS);
        return;
    }
    doubts[at] = pixel.x | pixel.y << 16 | flags;
    atomicMax(dispatch.x, at / GROUP + 1u);
    atomicMax(dispatch.y, 1u);
    atomicMax(dispatch.z, 1u);
}
