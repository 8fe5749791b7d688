// What a pixel sees of solids that are seen through, as four floats: the first word of visible.glsl, the (u, v) of an
// operand's patch, and the depth. 0 in all of them: nothing. All but the depth hold whole numbers.
//
//   x   the word's bits 0 to 23        z   bits 16 to 31 of (u, v)
//   y   24 to 31, and above them       w   depth along the view axis
//       bits 0 to 15 of (u, v)
#ifndef LAYER_WORDS_GLSL
#define LAYER_WORDS_GLSL

const uint LOW_BITS = 24u; // a float holds whole numbers of so many bits
const uint HIGH_BITS = 8u;
const uint UV_BITS = 16u;

vec4 pack_layer(uint word, uint uv, float t) {
    uint high = word >> LOW_BITS | (uv & ((1u << UV_BITS) - 1u)) << HIGH_BITS;
    return vec4(word & ((1u << LOW_BITS) - 1u), high, uv >> UV_BITS, t);
}

uint layer_word(vec4 packed) {
    return uint(packed.x) | (uint(packed.y) & ((1u << HIGH_BITS) - 1u)) << LOW_BITS;
}

uint layer_uv(vec4 packed) { return uint(packed.y) >> HIGH_BITS | uint(packed.z) << UV_BITS; }

#endif
