#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `blister`: a triangle of an operand behind the previous layer, like blister_peel.frag. The host sets which
// orientation it must have.
#include "scene.glsl"
#include "view.glsl"
#include "solids.glsl"
#include "eye_ray.glsl"
#include "boundary_operands.glsl"
#include "blister.glsl"
#include "visible.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Views { View views[]; };
layout(scalar, binding = 2) readonly buffer OperandMeshes { OperandMesh operand_meshes[]; };
layout(scalar, binding = 3) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 4) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = 5) readonly buffer Planes { uint planes[]; };
layout(binding = 6) uniform samplerBuffer surfaces;
layout(binding = 7) uniform samplerBuffer surface_places;
layout(binding = 8, rg32ui) readonly uniform uimage2D before;
layout(binding = 9, rg32ui) readonly uniform uimage2D found;

#include "triangle_depth.glsl"

layout(location = 0) flat in uvec2 crossed;
layout(location = 0) out uvec2 layer;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec2 from = imageLoad(before, pixel).xy;
    if (from.x == 0u) discard;
    if ((asked & PEEL_UNLOCKS) == 0u && imageLoad(found, pixel).x != 0u) discard; // locked
    OperandMesh mesh = operand_meshes[crossed.x];
    bool leaves = gl_FrontFacing == (mesh.mirrored != 0u);
    if ((asked & (leaves ? PEEL_EXITS : PEEL_ENTRIES)) == 0u) discard;
    float t = triangle_depth(mesh, crossed.y, gl_FragCoord.xy);
    if (!(t > uintBitsToFloat(from.y) && t < frame.far)) discard;
    layer = uvec2(SEEN_SOLID | frame.side_count + crossed.y, floatBitsToUint(t));
    gl_FragDepth = layer_depth(frame, t);
}
