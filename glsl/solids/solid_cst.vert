#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_cst`: two triangles over the tiles that may show a leaf. One instance a leaf, in an order that gives each
// shared face its owner.
#include "scene.glsl"
#include "solids.glsl"
#include "tiles.glsl"
#include "trimmed_leaf.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 8) readonly buffer Rects { Rect rects[]; };
layout(scalar, binding = 9) readonly buffer Order { uint order[]; };

layout(location = 0) flat out uint ordered;

void main() {
    ordered = order[gl_InstanceIndex];
    Rect rect = rects[ordered & LEAF_OF];
    bool seen = all(lessThanEqual(rect.first, rect.last));
    gl_Position = seen ? tile_corner(frame, rect, gl_VertexIndex) : OFF_THE_PICTURE;
}
