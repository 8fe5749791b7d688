#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `border_mean`: the mean of what a pixel's points see, in scenes with meshes or Boolean solids. One thread a
// pixel of the list.
#include "scene.glsl"
#include "view.glsl"
#include "visible.glsl"
#include "shade.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 2, rg32ui) readonly uniform uimage2D meshes_and_solids; // in scenes without trims the same
layout(binding = 3, rgba32f) readonly uniform image2D resolved; // linear colour, depth; UNSEEN where nothing is
#include "border_pixel.glsl"
#include "unmixed.glsl"
#include "border_seen.glsl"
#include "border_kinds.glsl"
layout(scalar, binding = 4) buffer List { BorderPixel list[]; };
layout(scalar, binding = 5) readonly buffer Grids { BorderGrids grids; };
layout(scalar, binding = 6) readonly buffer SeenPoints { BorderPoint seen_points[]; };

bool is_sampled_at(ivec2 at) {
    uint word = imageLoad(visibility, at).x;
    return is_sampled(sees_nothing(word) ? imageLoad(meshes_and_solids, at).x : word);
}

void main() {
    uint n = thread_number();
    if (n >= grids.count) return;
    ivec2 at = pixel_of(list[n]);
    uint unsampled = 0u; // bits of pixels around
    for (uint from = 0u; from < AROUND; ++from) {
        ivec2 beside = around(at, from);
        if (is_in_picture(beside) && !is_sampled_at(beside)) unsampled |= 1u << from;
    }
    // a surface that is not sampled covers its whole pixel, except for what lies before it
    bool own = (unsampled >> OWN & 1u) != 0u;
    float own_depth = imageLoad(resolved, at).a;
    vec4 sum = vec4(0.0);
    for (uint k = 0u; k < BORDER_POINTS; ++k) {
        BorderPoint seen = seen_points[n * BORDER_POINTS + k];
        uint shown = own && own_depth < UNSEEN && seen.depth >= own_depth ? OWN : seen.shown;
        sum += shown_at(at, k, shown, unsampled, list[n].sliver);
    }
    list[n].mean = packed_mean(sum);
}
