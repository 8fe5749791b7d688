#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `depth_pyramid`: the farthest visible depth in each square of few pixels, in each tile, and in each block of
// tiles. One workgroup a block, one thread a tile. Twin: src/twin/occlusion.rs.
#include "scene.glsl"
#include "tiles.glsl"
#include "depth_pyramid.glsl"

layout(local_size_x = 64) in; // BLOCK x BLOCK
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1) uniform sampler2D depth; // reversed
layout(scalar, binding = 2) writeonly buffer Farthest { float farthest[]; }; // depth_pyramid.glsl

shared float of_tiles[BLOCK * BLOCK];

float of_square(ivec2 corner, ivec2 end) {
    float least = 1.0; // depths are at most 1
    for (int y = corner.y; y < end.y; ++y) {
        for (int x = corner.x; x < end.x; ++x) least = min(least, texelFetch(depth, ivec2(x, y), 0).x);
    }
    return least;
}

void main() {
    uint n = gl_LocalInvocationID.x;
    uvec2 tile = gl_WorkGroupID.xy * BLOCK + uvec2(n % BLOCK, n / BLOCK);
    uint side = square_side(frame);
    uint per_tile = TILE / side;
    uvec2 squares = square_count(frame, side);
    float least = 1.0;
    for (uint k = 0u; k < per_tile * per_tile; ++k) {
        uvec2 square = tile * per_tile + uvec2(k % per_tile, k / per_tile);
        if (any(greaterThanEqual(square, squares))) continue;
        ivec2 corner = ivec2(square * side);
        float here = of_square(corner, min(corner + ivec2(side), ivec2(frame.size)));
        farthest[square.y * squares.x + square.x] = here;
        least = min(least, here);
    }
    of_tiles[n] = least;
    uvec2 tiles = square_count(frame, TILE);
    if (all(lessThan(tile, tiles))) farthest[first_square(frame, TILE) + tile.y * tiles.x + tile.x] = least;
    barrier();
    if (n != 0u) return;
    for (uint k = 1u; k < BLOCK * BLOCK; ++k) least = min(least, of_tiles[k]);
    uint across = square_count(frame, TILE * BLOCK).x;
    farthest[first_square(frame, TILE * BLOCK) + gl_WorkGroupID.y * across + gl_WorkGroupID.x] = least;
}
