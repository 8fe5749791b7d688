#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `border_write`: writes the means of passes `border_mix` and `border_mean` over the pixels' own colours, once no
// neighbour reads these any more. One thread a pixel of the list.
#include "scene.glsl"
#include "view.glsl"
#include "shade.glsl"
layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
#include "border_pixel.glsl"
layout(scalar, binding = 1) readonly buffer List { BorderPixel list[]; };
layout(scalar, binding = 2) readonly buffer Grids { BorderGrids grids; };
layout(binding = 3, rgba32f) uniform image2D resolved; // of a mean: linear colour, less its opacity

// Layers are drawn over the means, before the depths of the pixels' centres.
layout(constant_id = 39) const bool KEEPS_DEPTH = false;

void main() {
    uint n = thread_number();
    if (n >= grids.count) return;
    vec4 mean = vec4(unpackHalf2x16(list[n].mean.x), unpackHalf2x16(list[n].mean.y));
    ivec2 at = pixel_of(list[n]);
    float depth = KEEPS_DEPTH ? imageLoad(resolved, at).a : UNSEEN;
    if (depth >= UNSEEN) imageStore(resolved, at, vec4(mean.rgb, mean.a > 0.0 ? -mean.a : UNSEEN));
    else if (mean.a > 0.0) imageStore(resolved, at, vec4(mean.rgb / mean.a, depth));
}
