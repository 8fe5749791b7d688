#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_squares`: which squares of tiles are drawn, so that a pixel that may see no solid costs nothing, and
// few pixels lie beside a square's diagonal, where both of its triangles are at work. One thread a tile.
// Twin: src/twin/solid_squares.rs.
//
//   ┌───────┬───┐     the largest square of 8, 4, 2 or 1 tiles a side, aligned to its own side from the band's top, all
//   │       ├───┘     of whose tiles (of those within the picture) are in the band and may see a solid: its first tile
//   │       │         draws it
//   └───────┘
#include "scene.glsl"
#include "solids.glsl"
#include "tiles.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer TileEntries { uint tile_entries[]; };
layout(scalar, binding = 2) writeonly buffer TileSquares { uint tile_squares[]; };

// Of tiles of the band, which is `down` tiles high.
bool all_see(uvec2 first, uint side, uint across, uint down) {
    uvec2 end = min(first + side, uvec2(across, down));
    bool all_ = true;
    for (uint y = first.y; y < end.y && all_; ++y) {
        for (uint x = first.x; x < end.x && all_; ++x) {
            all_ = tile_entries[first_of_band(frame) + y * across + x] != EXIT_FALSE;
        }
    }
    return all_;
}

void main() {
    uint n = gl_GlobalInvocationID.x;
    uvec2 tiles = band_tiles(frame);
    if (n >= tiles.x * tiles.y) return;
    uvec2 tile = uvec2(n % tiles.x, n / tiles.x);
    bool is_last = frame.band_top / TILE + tiles.y == tile_count(frame).y;
    uint drawn = 0u;
    for (uint side = BLOCK; side > 0u; side /= 2u) {
        uvec2 first = tile / side * side;
        // the next band's tiles have squares of their own
        bool fits = is_last || first.y + side <= tiles.y;
        if (!fits || !all_see(first, side, tiles.x, tiles.y)) continue;
        if (first == tile) drawn = side;
        break;
    }
    tile_squares[first_of_band(frame) + n] = drawn;
}
