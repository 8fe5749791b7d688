// Pass `resolve`, spline faces of operands of Boolean solids: like resolve.frag, in pixels where pass `solid_events`
// found one.
#ifndef RESOLVE_OPERAND_GLSL
#define RESOLVE_OPERAND_GLSL

#include "scene.glsl"
#include "view.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 8, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 9, rg32ui) readonly uniform uimage2D meshes_and_solids; // without trims, the same image
layout(binding = 10, r32ui) readonly uniform uimage2D operand_uv;

#include "eye_ray.glsl"
#define INSTANCES_BINDING 7
#include "placed.glsl"
#include "patch.glsl"
#include "resolved.glsl"
#include "resolved_patch.glsl"

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec2 seen = imageLoad(visibility, pixel).xy;
    if (sees_nothing(seen.x)) seen = imageLoad(meshes_and_solids, pixel).xy;
    if (!sees_operand(seen.x)) discard;
    write_patch(uvec2(seen.x, imageLoad(operand_uv, pixel).x), true);
}

#endif
