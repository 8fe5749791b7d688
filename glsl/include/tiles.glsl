// The picture in tiles of 16 x 16 pixels, and blocks of 8 x 8 tiles. Twin of src/abi/solids.rs.
//
//   if the lists of all tiles and pixels are too large,       ┌───────────────┐
//   they are made for one band of rows at a time, which       │ 0  1  2  3    │ band_top     tiles and pixels are
//   begins at `band_top`                                      │ 4  5  6  7    │              numbered within the band
//                                                            └───────────────┘
#ifndef TILES_GLSL
#define TILES_GLSL

const uint TILE = 16u;  // pixels
const uint BLOCK = 8u;  // tiles
const uint LEAF_RUN = 32768u; // leaves that one thread tests: drivers may end longer loops

// Tiles from first to last, inclusive; none if first > last.
struct Rect {
    uvec2 first;
    uvec2 last;
};

// A leaf in a tile, with exits to other leaves there: TileLeaf indices or EXIT_*.
struct TileLeaf {
    uint leaf;      // and TILE_LEAF_*
    uint in_exit;
    uint out_exit;
    uint of;        // the leaf's own: first << LEAF_FLAG_BITS | flags
};

// The walk of an item that rays are followed through begins here.
const uint TILE_LEAF_ENTRY = 0x80000000u;
// Every walk of the union that ends inside passes this leaf.
const uint TILE_LEAF_GATE = 0x40000000u;

uint leaf_number(TileLeaf here) { return here.leaf & ~(TILE_LEAF_ENTRY | TILE_LEAF_GATE); }

// An entry of the list as texels: a driver fetches a texel at once, but may load a struct word by word.
TileLeaf tile_leaf_at(usamplerBuffer tile_leaves, uint i) {
    uvec4 texel = texelFetch(tile_leaves, int(i));
    return TileLeaf(texel.x, texel.y, texel.z, texel.w);
}

uvec2 tile_count(Frame frame) { return (uvec2(frame.size) + TILE - 1u) / TILE; }

// Rows of pixels in the band.
uint band_rows(Frame frame) { return min(frame.band_height, uint(frame.size.y) - frame.band_top); }
uvec2 band_tiles(Frame frame) { return uvec2(tile_count(frame).x, (band_rows(frame) + TILE - 1u) / TILE); }

// The number of a pixel in the band, and of its tile.
uint pixel_in_band(Frame frame, uvec2 pixel) { return (pixel.y - frame.band_top) * uint(frame.size.x) + pixel.x; }
uint tile_in_band(Frame frame, uvec2 pixel) {
    return (pixel.y - frame.band_top) / TILE * tile_count(frame).x + pixel.x / TILE;
}

// The band's first tile, among all tiles of the picture.
uint first_of_band(Frame frame) { return frame.band_top / TILE * tile_count(frame).x; }

// Number of runs in which each block's list is made.
uint run_count(Frame frame) { return (frame.leaf_count + LEAF_RUN - 1u) / LEAF_RUN; }

uvec2 block_count(Frame frame) { return (tile_count(frame) + BLOCK - 1u) / BLOCK; }

// A position outside every pixel.
const vec4 OFF_THE_PICTURE = vec4(-2.0, -2.0, 0.0, 1.0);

// A corner, 0 to 5, of the two triangles over these tiles, clamped to the picture: if the rasteriser clipped them, a
// pixel on their diagonal might be in neither.
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
