// Whether everything in a rectangle of pixels is nearer than a depth, by the farthest depths of squares. Needs the
// frame's constants and `farthest` (depth_pyramid.glsl). Twin: src/twin/occlusion.rs.
#ifndef NEARER_GLSL
#define NEARER_GLSL

#include "depth_pyramid.glsl"

const uint MOST_SQUARES = 10u; // tested along each axis; larger squares if there are more

// Whether every square of this side, from the first to the last, is nearer than `z`. False if the loop ends early:
// llvmpipe ends loops of a shader after too many steps.
bool all_nearer(uvec2 first, uvec2 last, uint side, float z) {
    uint base = first_square(frame, side);
    uint across = square_count(frame, side).x;
    uint asked = 0u;
    bool nearer = true;
    for (uint y = first.y; y <= last.y && nearer; ++y) {
        for (uint x = first.x; x <= last.x && nearer; ++x) {
            ++asked;
            nearer = farthest[base + y * across + x] > z;
        }
    }
    uvec2 all_ = last - first + 1u;
    return nearer && asked == all_.x * all_.y;
}

// Whether every pixel from `low` to `high` shows something nearer than the reversed depth `z`.
bool all_pixels_nearer(uvec2 low, uvec2 high, float z) {
    uint side = TILE * BLOCK;
    if (all(lessThan(high / TILE - low / TILE, uvec2(MOST_SQUARES)))) side = TILE;
    uint least = square_side(frame);
    if (all(lessThan(high / least - low / least, uvec2(MOST_SQUARES)))) side = least;
    return all_nearer(low / side, high / side, side, z);
}

#endif
