#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `operand_mesh`: three vertices a triangle, as in mesh.vert. Nothing is cut off at the far plane: who
// is within a mesh at the near plane is told by all that lies behind.
#include "scene.glsl"
#include "view.glsl"
#include "shells.glsl"

layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Views { View views[]; };
layout(scalar, binding = 2) readonly buffer OperandMeshes { OperandMesh operand_meshes[]; };
layout(scalar, binding = 3) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 4) readonly buffer Positions { vec3 positions[]; };

layout(location = 0) flat out uvec3 crossed; // shell, side, mirrored
layout(location = 1) flat out vec2 range;    // of the corners' depths

void main() {
    OperandMesh mesh = operand_meshes[gl_InstanceIndex];
    View view = views[mesh.instance];
    uint corner = uint(gl_VertexIndex);
    uint first = corner - corner % 3u;
    vec3 depths;
    for (uint k = 0u; k < 3u; ++k) depths[k] = row_times(view.depth, vec4(positions[triangles[first + k]], 1.0));
    gl_Position = to_clip_unending(frame, to_pixel(view, vec4(positions[triangles[corner]], 1.0)));
    crossed = uvec3(mesh.shell, mesh.first_side + first / 3u - mesh.first_triangle, mesh.mirrored);
    range = vec2(min(depths.x, min(depths.y, depths.z)), max(depths.x, max(depths.y, depths.z)));
}
