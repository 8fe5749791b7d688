// Covers the drawn tiles by few squares, so that few pixels lie on a square's diagonal, where both of its triangles
// cost time. The includer defines `bool is_drawn(uvec2 tile)`. Twin: src/twin/squares.rs.
//
//   ┌───────┬───┐     the largest square of 8, 4, 2 or 1 tiles a side, aligned to its own size, all of whose tiles
//   │       ├───┘     within the picture are drawn: its first tile draws it
//   │       │
//   └───────┘
#ifndef LARGEST_SQUARE_GLSL
#define LARGEST_SQUARE_GLSL

#include "tiles.glsl"

// The side of the square that a tile of `tiles` draws, in tiles; 0 if it is not drawn, or belongs to another tile's
// square. `ends`: no tiles follow below these, so squares may extend beyond them.
uint largest_square(uvec2 tile, uvec2 tiles, bool ends) {
    for (uint side = BLOCK; side > 0u; side /= 2u) {
        uvec2 first = tile / side * side;
        uvec2 end = min(first + side, tiles);
        bool all_ = ends || first.y + side <= tiles.y;
        for (uint y = first.y; y < end.y && all_; ++y) {
            for (uint x = first.x; x < end.x && all_; ++x) all_ = is_drawn(uvec2(x, y));
        }
        if (all_) return first == tile ? side : 0u;
    }
    return 0u;
}

#endif
