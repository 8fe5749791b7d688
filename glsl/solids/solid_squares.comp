#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_squares`: the squares of the band's tiles that are drawn, so that pixels that cannot show a solid cost
// nothing. One thread a tile. Twin: src/twin/squares.rs.
#include "scene.glsl"
#include "solids.glsl"
#include "tiles.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer TileEntries { uint tile_entries[]; };
layout(scalar, binding = 2) writeonly buffer TileSquares { uint tile_squares[]; };

bool is_drawn(uvec2 tile) {
    return tile_entries[first_of_band(frame) + tile.y * band_tiles(frame).x + tile.x] != EXIT_FALSE;
}

#include "largest_square.glsl"

void main() {
    uint n = thread_number();
    uvec2 tiles = band_tiles(frame);
    if (n >= tiles.x * tiles.y) return;
    // the next band's tiles have squares of their own
    bool is_last = frame.band_top / TILE + tiles.y == tile_count(frame).y;
    tile_squares[first_of_band(frame) + n] = largest_square(uvec2(n % tiles.x, n / tiles.x), tiles, is_last);
}
