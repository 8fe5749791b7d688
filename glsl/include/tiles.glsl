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

bool meets(Rect r, uvec2 first, uvec2 last) {
    return all(lessThanEqual(r.first, last)) && all(greaterThanEqual(r.last, first)) &&
           all(lessThanEqual(r.first, r.last));
}

#endif
