// Pass `resolve`, meshes: the point of the triangle at the pixel's centre, then light. The image (u, v)
// gets the weights of the second and the third corner.
#ifndef RESOLVE_MESH_GLSL
#define RESOLVE_MESH_GLSL

#include "scene.glsl"
#include "view.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Views { View views[]; };
layout(scalar, binding = 2) readonly buffer Instances { Instance instances[]; };
layout(scalar, binding = 3) readonly buffer MeshInstances { MeshInstance mesh_instances[]; };
layout(scalar, binding = 4) readonly buffer Meshes { Mesh meshes[]; };
layout(scalar, binding = 5) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 6) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = 7) readonly buffer Normals { uint normals[]; };
layout(binding = 8, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 9, rg32ui) readonly uniform uimage2D meshes_and_solids; // without trims, the same image

#include "facet.glsl"
#include "octahedral.glsl"
#include "resolved.glsl"
#include "visible.glsl"

vec3 corner_normal(uint corner) { return normalize(octahedral(normals[corner])); }

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uvec2 seen = imageLoad(visibility, at).xy;
    if (sees_nothing(seen.x)) seen = imageLoad(meshes_and_solids, at).xy;
    if (!sees_mesh(seen.x)) discard;
    MeshInstance placed = mesh_instances[seen_mesh_instance(seen.x)];
    Mesh mesh = meshes[placed.mesh];
    Instance instance = instances[placed.instance];
    Facet f = facet_at(seen.y, views[placed.instance], gl_FragCoord.xy);

    vec3 n = across(f.ab, f.ac);
    if ((mesh.flags & MESH_NORMALS) != 0u) {
        uint corner = mesh.first_normal + 3u * (seen.y - mesh.first_triangle);
        n = corner_normal(corner) * (1.0 - f.st.x - f.st.y) +
            corner_normal(corner + 1u) * f.st.x + corner_normal(corner + 2u) * f.st.y;
    }
    n = instance.normal * n;
    float size = length(n);
    n = size > 0.0 ? n / size : -frame.forward;
    if (instance.mirrored != 0u) n = -n;
    bool solid = (mesh.flags & MESH_SOLID) != 0u;
    write_surface(mesh.colour, instance, n, solid, f.depth, mesh.id, f.st, NO_SURFACE, NO_CURVATURE);
}

#endif
