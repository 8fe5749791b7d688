// The farthest visible depths: of squares of square_side(frame) pixels a side, row by row, then of tiles, then of
// blocks of tiles. Needs scene.glsl and tiles.glsl. Twin: src/twin/occlusion.rs.
#ifndef FARTHEST_GLSL
#define FARTHEST_GLSL

const uint SQUARE = 4u; // pixels
// Patches cover few pixels of a small picture: larger squares around them reach beyond what hides them.
const uint SMALL_SQUARE = 2u;
const uint SMALL_PICTURE = 131072u; // pixels

uint square_side(Frame frame) {
    uvec2 size = uvec2(frame.size);
    return size.x * size.y <= SMALL_PICTURE ? SMALL_SQUARE : SQUARE;
}

// Numbers of squares with this side in pixels, across and down.
uvec2 square_count(Frame frame, uint side) { return (uvec2(frame.size) + side - 1u) / side; }

// Index of the first square with side square_side(frame), TILE or TILE * BLOCK.
uint first_square(Frame frame, uint side) {
    uint first = 0u;
    uint least = square_side(frame);
    if (side > least) {
        uvec2 squares = square_count(frame, least);
        first += squares.x * squares.y;
    }
    if (side > TILE) {
        uvec2 tiles = square_count(frame, TILE);
        first += tiles.x * tiles.y;
    }
    return first;
}

#endif
