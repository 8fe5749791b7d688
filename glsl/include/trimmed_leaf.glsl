// Which leaf an instance of pass `solid_cst` draws, and what for. Twin of src/scene/solids/order.rs.
#ifndef TRIMMED_LEAF_GLSL
#define TRIMMED_LEAF_GLSL

const uint LEAF_OF = 0x7fffffffu;

// Draw where the leaf shares a face that no leaf changes alone, too: comes after all others, so that it
// shows only where they have left the depth to it.
const uint UNOWNED = 0x80000000u;

#endif
