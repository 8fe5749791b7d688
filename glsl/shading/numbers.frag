#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `numbers`: writes the part and the instance visible in each pixel, from 1 on.
#include "scene.glsl"
#include "visible.glsl"
#include "words.glsl"

layout(binding = 0) uniform usamplerBuffer sources; // for an instance of the scene: part and instance, from 1 on
layout(binding = 1) uniform usamplerBuffer face_instances;
layout(binding = 2) uniform usamplerBuffer patch_instances;
layout(binding = 3, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 4, rg32ui) readonly uniform uimage2D meshes_and_solids; // without trims, the same image
layout(scalar, binding = 5) readonly buffer MeshInstances { MeshInstance mesh_instances[]; }; // only with meshes

layout(location = 0) out uint out_edge; // of lines, which are drawn later
layout(location = 1) out uint out_part;
layout(location = 2) out uint out_instance;

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint seen = imageLoad(visibility, at).x;
    if (sees_nothing(seen)) seen = imageLoad(meshes_and_solids, at).x;
    if (sees_nothing(seen) || sees_solid(seen) || sees_operand(seen)) discard;
    uint instance = 0u;
    if (sees_mesh(seen)) {
        instance = mesh_instances[seen_mesh_instance(seen)].instance;
    } else {
        instance = texelFetch(face_instances, int(word_at(patch_instances, seen_patch_instance(seen))) * 2).y;
    }
    uvec2 source = texelFetch(sources, int(instance)).xy;
    out_edge = 0u;
    out_part = source.x;
    out_instance = source.y;
}
