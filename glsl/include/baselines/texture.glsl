// A trim texture a placed face, one bit a texel. What it is: src/baselines/texture.rs.
#ifndef TEXTURE_GLSL
#define TEXTURE_GLSL

// Rows of a texture; more is more than any storage buffer of these widths holds.
const float TEXTURE_MOST_ROWS = 65536.0;
// Texels along a row, so that sizes fit in 32 bits.
const float TEXTURE_MOST_COLUMNS = 16777216.0;

struct TextureSize {
    uint columns;
    uint rows;
    uint words; // of a row
};

// Where the texture of a placed face is: at the index of its first strip, which is its alone.
struct TexturePlace {
    TextureSize size;
    uint start;
};

// Texels of a face that is seen at so many pixels per unit of u and of v; none for one that is not seen.
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
