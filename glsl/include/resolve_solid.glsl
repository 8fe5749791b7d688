// Pass `resolve`, Boolean solids: normal and light of the side that pass `solid_events` found. Its depth is already
// exact.
#ifndef RESOLVE_SOLID_GLSL
#define RESOLVE_SOLID_GLSL

#include "scene.glsl"
#include "view.glsl"
#include "solids.glsl"
#include "eye_ray.glsl"
#include "boundary_operands.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(binding = 2) uniform usamplerBuffer leaf_surfaces;
layout(binding = 3) uniform samplerBuffer surfaces;
layout(binding = 4) uniform samplerBuffer surface_places;
layout(binding = 5, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 6, rg32ui) readonly uniform uimage2D meshes_and_solids; // without trims, the same image
layout(scalar, binding = 8) readonly buffer Instances { Instance instances[]; };
layout(scalar, binding = 9) readonly buffer OperandMeshes { OperandMesh operand_meshes[]; };
layout(scalar, binding = 10) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 11) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = 12) readonly buffer Planes { uint planes[]; };
layout(scalar, binding = 13) readonly buffer Views { View views[]; };

#include "resolved.glsl"
#include "sides.glsl"
#include "visible.glsl"
#include "side_curvature.glsl"

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec2 seen = imageLoad(visibility, pixel).xy;
    if (sees_nothing(seen.x)) seen = imageLoad(meshes_and_solids, pixel).xy;
    if (!sees_solid(seen.x)) discard;
    float t = uintBitsToFloat(seen.y);
    Ray ray = eye_ray(frame, gl_FragCoord.xy);
    Side side = side_at(seen_side(seen.x), t, ray);
    Leaf leaf = leaves[side.leaf];
    vec3 n = normalize(side.n);
    // the solid begins here, so its outside is before it
    if (dot(n, ray.d) > 0.0) n = -n;
    Instance nowhere = Instance(mat3(1.0), 1.0, 0u, 0u, 0u, uvec3(0u)); // leaves are not placed
    Curvature curvature = NO_CURVATURE;
    if (shows_curvature()) curvature = side_curvature(seen_side(seen.x), t, ray);
    vec2 no_uv = vec2(uintBitsToFloat(0x7fc00000u));
    write_surface(leaf.colour, nowhere, n, true, t, leaf.id, no_uv, side.surface, curvature);
}

#endif
