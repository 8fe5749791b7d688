#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `operand_mesh`: three vertices a triangle, as in mesh.vert. Nothing is clipped at the far plane: all crossings
// behind the near plane determine whether the near plane is within a mesh.
#include "scene.glsl"
#include "view.glsl"
#include "boundary_operands.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Views { View views[]; };
layout(scalar, binding = 2) readonly buffer OperandMeshes { OperandMesh operand_meshes[]; };
layout(scalar, binding = 3) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 4) readonly buffer Positions { vec3 positions[]; };

layout(location = 0) flat out uvec2 crossed; // mesh, triangle

void main() {
    View view = views[operand_meshes[gl_InstanceIndex].instance];
    uint corner = uint(gl_VertexIndex);
    gl_Position = to_clip_unending(frame, to_pixel(view, vec4(positions[triangles[corner]], 1.0)));
    crossed = uvec2(gl_InstanceIndex, corner / 3u);
}
