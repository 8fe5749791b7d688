// A trim texture for each placed face, one bit a texel: src/baselines/texture.rs.
#ifndef TEXTURE_GLSL
#define TEXTURE_GLSL

// Most rows of a texture; no storage buffer holds more rows of these widths.
const float TEXTURE_MOST_ROWS = 65536.0;
// Most texels of a row, so that sizes fit in 32 bits.
const float TEXTURE_MOST_COLUMNS = 16777216.0;

struct TextureSize {
    uint columns;
    uint rows;
    uint words; // of a row
};

// The place of a placed face's texture, stored at the index of its first strip, which no other face uses.
struct TexturePlace {
    TextureSize size;
    uint start;
};

// Texels of a face that covers so many pixels per unit of u and of v; none for a face that is not visible.
TextureSize texture_size(vec2 speed, float texels_per_px) {
    vec2 texels = ceil(speed * texels_per_px);
    if (!(texels.x > 0.0 || texels.y > 0.0)) return TextureSize(0u, 0u, 0u);
    uint columns = uint(clamp(texels.x, 1.0, TEXTURE_MOST_COLUMNS));
    uint rows = uint(clamp(texels.y, 1.0, TEXTURE_MOST_ROWS));
    return TextureSize(columns, rows, (columns + 31u) / 32u);
}

vec2 texture_speed(uint u, uint v) {
    return vec2(uintBitsToFloat(u), uintBitsToFloat(v));
}

#endif
