// The picture in tiles of 16 x 16 pixels, and blocks of 8 x 8 tiles. Twin of src/abi/solids.rs.
#ifndef TILES_GLSL
#define TILES_GLSL

const uint TILE = 16u;  // pixels
const uint BLOCK = 8u;  // tiles

// Tiles from first to last, both counted in; nowhere when first > last.
struct Rect {
    uvec2 first;
    uvec2 last;
};

// A leaf in a tile, wired to the others there; exits are TileLeaf indices or EXIT_*.
struct TileLeaf {
    uint leaf;      // and TILE_LEAF_ENTRY
    uint in_exit;
    uint out_exit;
};

// The walk of an item that rays are followed through begins here.
const uint TILE_LEAF_ENTRY = 0x80000000u;

uvec2 tile_count(Frame frame) { return (uvec2(frame.size) + TILE - 1u) / TILE; }
uvec2 block_count(Frame frame) { return (tile_count(frame) + BLOCK - 1u) / BLOCK; }

// Of no pixel.
const vec4 OFF_THE_PICTURE = vec4(-2.0, -2.0, 0.0, 1.0);

// A corner, 0 to 5, of the two triangles over these tiles. Within the picture: were they clipped, a pixel on their
// diagonal might be in neither.
vec4 tile_corner(Frame frame, Rect rect, uint n) {
    uint corner = n < 3u ? n : 6u - n; // 0 1 2, 3 2 1
    uvec2 tile = uvec2((corner & 1u) == 0u ? rect.first.x : rect.last.x + 1u,
                       (corner & 2u) == 0u ? rect.first.y : rect.last.y + 1u);
    vec2 pixel = min(vec2(tile * TILE), frame.size);
    return vec4(pixel * 2.0 / frame.size - 1.0, 0.0, 1.0);
}

bool meets(Rect r, uvec2 first, uvec2 last) {
    return all(lessThanEqual(r.first, last)) && all(greaterThanEqual(r.last, first)) &&
           all(lessThanEqual(r.first, r.last));
}

#endif
