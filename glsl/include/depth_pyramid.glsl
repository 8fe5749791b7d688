// The farthest depths that are seen: squares of SQUARE pixels a side row by row, then tiles, then blocks of tiles. Needs
// scene.glsl and tiles.glsl. Twin: src/twin/occlusion.rs.
#ifndef FARTHEST_GLSL
#define FARTHEST_GLSL

const uint SQUARE = 4u; // pixels

// Squares of so many pixels a side, across and down.
uvec2 square_count(Frame frame, uint side) { return (uvec2(frame.size) + side - 1u) / side; }

// Where those of SQUARE, TILE or TILE * BLOCK begin.
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
