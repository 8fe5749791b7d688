// The leaf that an instance of pass `solid_cst` draws, and the purpose. Twin of src/scene/solids/order.rs.
#ifndef TRIMMED_LEAF_GLSL
#define TRIMMED_LEAF_GLSL

const uint LEAF_OF = 0x7fffffffu;

// The instance also draws where the leaf shares a face that no leaf changes by itself. It comes after all others, so
// that it is visible only where they have drawn nothing nearer.
const uint UNOWNED = 0x80000000u;

#endif
