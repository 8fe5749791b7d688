#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `seen_squares`: the squares of tiles that show a patch or a mesh, so that pass `resolve` draws only these. One
// workgroup for each block of tiles, one thread a tile. Twin: src/twin/squares.rs.
#include "scene.glsl"
#include "tiles.glsl"
#include "visible.glsl"

layout(local_size_x = 64) in; // BLOCK x BLOCK
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 2, rg32ui) readonly uniform uimage2D meshes_and_solids; // without trims, the same image
layout(scalar, binding = 3) writeonly buffer SeenSquares { uint seen_squares[]; };

shared bool seen[BLOCK * BLOCK];

bool is_drawn(uvec2 tile) {
    return seen[tile.y * BLOCK + tile.x];
}

#include "largest_square.glsl"

// Whether the pixel shows a patch or a mesh.
bool sees_surface(ivec2 pixel) {
    uint word = imageLoad(visibility, pixel).x;
    if (sees_nothing(word)) word = imageLoad(meshes_and_solids, pixel).x;
    return !sees_nothing(word) && !sees_solid(word) && !sees_operand(word);
}

void main() {
    uint n = gl_LocalInvocationID.x;
    uvec2 tiles = tile_count(frame);
    uvec2 first = gl_WorkGroupID.xy * BLOCK;
    uvec2 own = uvec2(n % BLOCK, n / BLOCK);
    ivec2 corner = ivec2((first + own) * TILE);
    ivec2 end = min(corner + ivec2(TILE), ivec2(frame.size));
    bool found = false;
    for (int y = corner.y; y < end.y && !found; ++y) {
        for (int x = corner.x; x < end.x && !found; ++x) found = sees_surface(ivec2(x, y));
    }
    seen[n] = found;
    barrier();
    uvec2 tile = first + own;
    if (all(lessThan(tile, tiles))) {
        seen_squares[tile.y * tiles.x + tile.x] = largest_square(own, min(tiles - first, uvec2(BLOCK)), true);
    }
}
