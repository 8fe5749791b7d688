// The word for the visible surface of a pixel.
//
//   first word    31  30-29   28 - 0             second word
//   nothing        0      0   0                  0
//   a patch        d      0   patch instance + 1   (u, v) of the patch, two 16-bit numbers
//   a mesh         0      1   mesh instance      triangle of the scene
//   a solid        0      2   side, triangle     depth along the view axis, a float
//   an operand     0      3   patch instance + 1   the same; for a spline face of a solid's operand. Its (u, v) are in
//                                                an image of their own, `operand_uv`
//
// d: a gap candidate, for pass `gap_fill`. In scenes with trims, meshes and solids are in an image of their own,
// `meshes_and_solids`, and are visible where `visibility` is empty.
#ifndef VISIBLE_GLSL
#define VISIBLE_GLSL

const uint GAP_CANDIDATE = 0x80000000u;
// In the list of gap candidates, whose columns and rows have 15 bits: the visible surface is not itself a candidate.
const uint BORDER_BEFORE = 0x80000000u;
// In addition to BORDER_BEFORE: there is no skirt, and the pixel is empty, between patches on both sides.
const uint ISOLATED = 0x8000u;
// Without BORDER_BEFORE: the visible surface is a candidate, and a skirt lies before it.
const uint BACK_BEHIND_BORDER = 0x8000u;
// The same, while the pixel has no mark: a front between back faces.
const uint FRONT_BETWEEN_BACKS = BACK_BEHIND_BORDER;
// Distance from a back face to which `gap_fill` searches for a front that it lies on.
const uint WIDE_BAND_PX = 16u;
const uint SEEN_KIND = 0x60000000u;
const uint SEEN_MESH = 0x20000000u;
const uint SEEN_SOLID = 0x40000000u; // Boolean
const uint SEEN_OPERAND = 0x60000000u;

// The scene has meshes or solids.
layout(constant_id = 4) const bool SCENE_HAS_MESHES_OR_SOLIDS = false;

bool sees_nothing(uint word) { return (word & ~GAP_CANDIDATE) == 0u; }
bool sees_other(uint word) { return SCENE_HAS_MESHES_OR_SOLIDS && (word & SEEN_KIND) != 0u; } // a mesh or solid
bool sees_mesh(uint word) { return (word & SEEN_KIND) == SEEN_MESH; }
bool sees_solid(uint word) { return (word & SEEN_KIND) == SEEN_SOLID; }
bool sees_operand(uint word) { return (word & SEEN_KIND) == SEEN_OPERAND; }

// Column and row of a word of that list.
ivec2 candidate_pixel(uint packed) { return ivec2(packed & 0x7fffu, (packed & ~BORDER_BEFORE) >> 16); }

uint seen_patch_instance(uint word) { return (word & ~(GAP_CANDIDATE | SEEN_KIND)) - 1u; }
uint seen_mesh_instance(uint word) { return word & ~(GAP_CANDIDATE | SEEN_KIND); }
uint seen_side(uint word) { return word & ~(GAP_CANDIDATE | SEEN_KIND); }

// A border of a patch may be continued by less than its width.
uint pack_uv(vec2 uv) { return packUnorm2x16((uv + 1.0) / 3.0); }
vec2 unpack_uv(uint word) { return unpackUnorm2x16(word) * 3.0 - 1.0; }

#endif
