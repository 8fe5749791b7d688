#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `farthest`: the farthest depth that is seen in each tile, and in each block of tiles. One workgroup a block,
// one thread a tile. Twin: src/twin/hidden.rs.
#include "scene.glsl"
#include "tiles.glsl"

layout(local_size_x = 64) in; // BLOCK x BLOCK
layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(binding = 1) uniform sampler2D depth; // reversed
layout(scalar, binding = 2) writeonly buffer Farthest { float farthest[]; }; // tiles row by row, then blocks

shared float of_tiles[BLOCK * BLOCK];

void main() {
    uint n = gl_LocalInvocationID.x;
    uvec2 tiles = tile_count(frame);
    uvec2 tile = gl_WorkGroupID.xy * BLOCK + uvec2(n % BLOCK, n / BLOCK);
    ivec2 corner = ivec2(tile * TILE);
    ivec2 end = min(corner + ivec2(TILE), ivec2(frame.size));
    float least = 1.0; // depths are at most 1
    for (int y = corner.y; y < end.y; ++y) {
        for (int x = corner.x; x < end.x; ++x) least = min(least, texelFetch(depth, ivec2(x, y), 0).x);
    }
    of_tiles[n] = least;
    if (all(lessThan(tile, tiles))) farthest[tile.y * tiles.x + tile.x] = least;
    barrier();
    if (n != 0u) return;
    for (uint k = 1u; k < BLOCK * BLOCK; ++k) least = min(least, of_tiles[k]);
    farthest[tiles.x * tiles.y + gl_WorkGroupID.y * block_count(frame).x + gl_WorkGroupID.x] = least;
}
