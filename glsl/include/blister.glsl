// Layers of faces, peeled one by one: shared by the passes of `blister`. Twin: src/frame/solids/blister.rs.
//
//   layer   the nearest face behind the layer before, of any primitive:
//           word of visible.glsl, 0 without a face │ depth, a float
#ifndef BLISTER_GLSL
#define BLISTER_GLSL

// The leaf or switch of a draw.
layout(push_constant) uniform Asked { uint asked; };

const uint PEEL_ENTRIES = 1u; // faces where the ray enters the primitive; for a negative leaf, where it leaves
const uint PEEL_EXITS = 2u;   // the other faces
const uint PEEL_UNLOCKS = 4u;   // faces found earlier lock no pixel; the search starts from them

// Depth images hold [0, 1]. A power of two maps the far plane there, so depths keep their bits, and equal depths stay
// equal.
float layer_depth(Frame frame, float t) {
    int exponent;
    frexp(frame.far, exponent);
    return ldexp(t, -exponent);
}

#endif
