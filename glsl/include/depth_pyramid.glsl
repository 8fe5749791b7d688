// The farthest visible depths: of squares with a side of SQUARE pixels, row by row, then of tiles, then of blocks of
// tiles. Needs scene.glsl and tiles.glsl. Twin: src/twin/occlusion.rs.
#ifndef FARTHEST_GLSL
#define FARTHEST_GLSL

const uint SQUARE = 4u; // pixels

// Numbers of squares with this side in pixels, across and down.
uvec2 square_count(Frame frame, uint side) { return (uvec2(frame.size) + side - 1u) / side; }

// Index of the first square with side SQUARE, TILE or TILE * BLOCK.
uint first_square(Frame frame, uint side) {
    uint first = 0u;
    if (side > SQUARE) {
        uvec2 squares = square_count(frame, SQUARE);
        first += squares.x * squares.y;
    }
    if (side > TILE) {
        uvec2 tiles = square_count(frame, TILE);
        first += tiles.x * tiles.y;
    }
    return first;
}

#endif
