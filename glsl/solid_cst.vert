#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `solid_cst`: two triangles over the tiles that may see a leaf. One instance a leaf, in the order
// that tells who owns a face that several share.
#include "scene.glsl"
#include "solids.glsl"
#include "tiles.glsl"
#include "trimmed_leaf.glsl"

layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(scalar, binding = 8) readonly buffer Rects { Rect rects[]; };
layout(scalar, binding = 9) readonly buffer Order { uint order[]; };

layout(location = 0) flat out uint asked;

void main() {
    asked = order[gl_InstanceIndex];
    Rect rect = rects[asked & LEAF_OF];
    bool seen = all(lessThanEqual(rect.first, rect.last));
    uint corner = gl_VertexIndex < 3 ? gl_VertexIndex : 6u - gl_VertexIndex; // 0 1 2, 3 2 1
    uvec2 tile = uvec2((corner & 1u) == 0u ? rect.first.x : rect.last.x + 1u,
                       (corner & 2u) == 0u ? rect.first.y : rect.last.y + 1u);
    vec2 pixel = vec2(tile * TILE);
    gl_Position = vec4(seen ? pixel * 2.0 / frame.size - 1.0 : vec2(-2.0), 0.0, 1.0);
}
