// Pass `resolve`, patches: the exact surface at the pixel's centre, then light.
//
// The visibility image holds (u, v) of the *tessellation* under the pixel; refine.glsl moves it to
// the point of the exact surface that projects to the pixel's centre.
#ifndef RESOLVE_GLSL
#define RESOLVE_GLSL

#include "scene.glsl"
#include "view.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 8, rg32ui) readonly uniform uimage2D visibility;

#include "eye_ray.glsl"
#define INSTANCES_BINDING 7
#include "placed.glsl"
#include "patch.glsl"
#include "resolved.glsl"
#include "resolved_patch.glsl"

void main() {
    uvec2 seen = imageLoad(visibility, ivec2(gl_FragCoord.xy)).xy;
    if (sees_nothing(seen.x) || sees_other(seen.x)) discard;
    write_patch(seen, false);
}

#endif
