#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `border_followed`: makes the mean of what a pixel's points see. Pass `border_mix` lists points, and pass
// `border_follow` follows them before. Scenes with meshes or Boolean solids do not have this pass. One thread a listed
// pixel.
#include "scene.glsl"
#include "view.glsl"
#include "visible.glsl"
#include "shade.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rgba32f) readonly uniform image2D resolved; // linear colour, depth; UNSEEN where nothing is
#include "border_pixel.glsl"
#include "unmixed.glsl"
#include "border_seen.glsl"
#include "border_followed.glsl"
layout(scalar, binding = 2) buffer List { BorderPixel list[]; };
layout(scalar, binding = 3) readonly buffer FollowedPoints { FollowedPoint followed_points[]; };
layout(scalar, binding = 4) readonly buffer FollowedPixels { FollowedPixel followed_pixels[]; };
layout(scalar, binding = 5) readonly buffer FollowedLists { FollowedGrids followed; };

void main() {
    uint n = thread_number();
    if (n >= followed.pixel_count) return;
    FollowedPixel pixel = followed_pixels[n];
    ivec2 at = pixel_of(list[pixel.place]);
    uvec2 all = list[pixel.place].mean; // what its points show
    uint next = pixel.first;
    vec4 sum = vec4(0.0);
    for (uint k = 0u; k < BORDER_POINTS; ++k) {
        uint shown = all[k / 8u] >> (4u * (k % 8u)) & 15u;
        bool was_followed = (pixel.bits >> k & 1u) != 0u;
        if (was_followed) shown = followed_points[next].sheets >> FOLLOWED_SHOWN;
        if (was_followed) ++next;
        sum += shown_at(at, k, shown, pixel.bits >> BORDER_POINTS, list[pixel.place].sliver);
    }
    list[pixel.place].mean = packed_mean(sum);
}
