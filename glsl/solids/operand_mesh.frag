#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `operand_mesh`: the crossing of a ray with a triangle of an operand. The depth is that of the triangle's plane.
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
layout(scalar, binding = 8) buffer FragmentCounts { uint fragment_counts[]; };
layout(scalar, binding = 9) readonly buffer FragmentStarts { uint fragment_starts[]; };
layout(scalar, binding = 10) writeonly buffer Fragments { Fragment fragments[]; };

#include "put_fragment.glsl"
#include "triangle_depth.glsl"

layout(location = 0) flat in uvec2 crossed;

void main() {
    OperandMesh mesh = operand_meshes[crossed.x];
    float depth = 0.0;
    if (FILLS) depth = triangle_depth(mesh, crossed.y, gl_FragCoord.xy);
    bool leaves = gl_FrontFacing == (mesh.mirrored != 0u);
    put_fragment(Fragment(mesh.operand | (leaves ? FRAGMENT_LEAVES : 0u), depth, frame.side_count + crossed.y, 0u));
}
