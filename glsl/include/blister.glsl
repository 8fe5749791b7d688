// Layers of faces, peeled off one by one: what the passes of `blister` share. Twin: src/frame/solids/blister.rs.
//
//   layer   the nearest face behind the layer before, of any primitive:
//           word of visible.glsl, 0 where there is none │ depth, a float
#ifndef BLISTER_GLSL
#define BLISTER_GLSL

// What a draw is about.
layout(push_constant) uniform Asked { uint asked; };

const uint PEEL_ENTRIES = 1u; // where the ray enters the primitive; where the leaf is negative, leaves it
const uint PEEL_EXITS = 2u;   // the reverse
const uint PEEL_UNLOCKS = 4u;   // what was found locks no pixel: the search begins there

// Depth images hold [0, 1], so the far plane is brought there by a power of two: the depth stays what it is, to the
// bit, and equal depths are equal.
float layer_depth(Frame frame, float t) {
    int exponent;
    frexp(frame.far, exponent);
    return ldexp(t, -exponent);
}

#endif
