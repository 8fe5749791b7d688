// A fragment of an operand: counted first, then stored from the pixel's prefix sum on. Needs `frame`,
// boundary_operands.glsl and buffers `uint fragment_counts[]`, `uint fragment_starts[]`, `Fragment fragments[]`. The
// order within a pixel is the rasteriser's; pass `operand_sort` sorts it.
#ifndef PUT_FRAGMENT_GLSL
#define PUT_FRAGMENT_GLSL

#include "tiles.glsl"

layout(constant_id = 12) const bool FILLS = false;

void put_fragment(Fragment f) {
    uint pixel = pixel_in_band(frame, uvec2(gl_FragCoord.xy));
    if (!FILLS) {
        atomicAdd(fragment_counts[pixel], 1u);
        return;
    }
    // the counts go down to 0 again
    uint left = atomicAdd(fragment_counts[pixel], 0xffffffffu);
    uint at = fragment_starts[pixel] + left - 1u;
    if (left > 0u && at < frame.fragment_capacity) fragments[at] = f;
}

#endif
