#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `mesh`: three vertices a triangle, one instance a mesh instance. Triangles that share a vertex
// compute it from the same numbers, so that they meet without a gap.
#include "scene.glsl"
#include "view.glsl"
#include "visible.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Views { View views[]; };
layout(scalar, binding = 2) readonly buffer MeshInstances { MeshInstance mesh_instances[]; };
layout(scalar, binding = 3) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 4) readonly buffer Positions { vec3 positions[]; };

layout(location = 0) flat out uvec2 seen;

void main() {
    uint corner = uint(gl_VertexIndex);
    uint placed = uint(gl_InstanceIndex);
    vec3 p = positions[triangles[corner]];
    gl_Position = to_clip(frame, to_pixel(views[mesh_instances[placed].instance], vec4(p, 1.0)));
    seen = uvec2(SEEN_MESH | placed, corner / 3u);
}
