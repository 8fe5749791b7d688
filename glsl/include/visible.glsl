// What the visibility image holds of a pixel.
#ifndef VISIBLE_GLSL
#define VISIBLE_GLSL

// First word: item + 1, or 0 where nothing is seen; and a flag for pass `heal`. Or SOLID and the
// number of the side (LeafSurface) + 1; the second word is the depth then.
const uint DOUBTFUL = 0x80000000u;
const uint SOLID = 0x40000000u;

uint seen_item(uint word) { return (word & ~DOUBTFUL) - 1u; }
bool sees_solid(uint word) { return (word & SOLID) != 0u; }
uint seen_side(uint word) { return (word & ~SOLID) - 1u; }
bool sees_nothing(uint word) { return (word & ~DOUBTFUL) == 0u; }

// (u, v) of a patch as two 16-bit numbers; a border may be continued by less than its width.
uint pack_uv(vec2 uv) { return packUnorm2x16((uv + 1.0) / 3.0); }
vec2 unpack_uv(uint word) { return unpackUnorm2x16(word) * 3.0 - 1.0; }

#endif
