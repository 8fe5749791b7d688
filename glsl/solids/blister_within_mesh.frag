#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `blister`: a triangle of an operand behind the layer's face. The stencil test inverts a bit: a point with an odd
// number of triangles behind it is inside. Triangles in front of it are not counted, since some may lie before the near
// plane.
#include "scene.glsl"
#include "view.glsl"
#include "solids.glsl"
#include "eye_ray.glsl"
#include "boundary_operands.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Views { View views[]; };
layout(scalar, binding = 2) readonly buffer OperandMeshes { OperandMesh operand_meshes[]; };
layout(scalar, binding = 3) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 4) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = 5) readonly buffer Planes { uint planes[]; };
layout(binding = 6) uniform samplerBuffer surfaces;
layout(binding = 7) uniform samplerBuffer surface_places;
layout(binding = 8, rg32ui) readonly uniform uimage2D layer;

#include "triangle_depth.glsl"

layout(location = 0) flat in uvec2 crossed;

void main() {
    uvec2 face = imageLoad(layer, ivec2(gl_FragCoord.xy)).xy;
    if (face.x == 0u) discard;
    OperandMesh mesh = operand_meshes[crossed.x];
    if (!(triangle_depth(mesh, crossed.y, gl_FragCoord.xy) > uintBitsToFloat(face.y))) discard;
}
