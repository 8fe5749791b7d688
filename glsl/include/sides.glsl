// The owner and the orientation of a Boolean solid's side: a side of a leaf with equations, or a triangle of an
// operand. Needs scene.glsl, solids.glsl, boundary_operands.glsl, view.glsl, eye_ray.glsl, `frame`,
// `usamplerBuffer leaf_surfaces`, and buffers `Instance instances[]`, `OperandMesh operand_meshes[]`, and those of
// triangle_depth.glsl.
#ifndef SIDES_GLSL
#define SIDES_GLSL

#include "triangle_depth.glsl"
#include "triangle_mesh.glsl"

// Whether some leaf is a boundary operand; the code for boundary operands is compiled in only then.
layout(constant_id = 13) const bool SOLIDS_HAVE_BOUNDARY_OPERANDS = true;

struct Side {
    uint leaf;
    vec3 n; // normal of the side, model directions, not of unit length
    uint surface; // number of its surface, or OWN_PLANE and the triangle's number
};

vec3 across_side(uint side, float t, Ray ray) {
    uint i = side >> SIDE_SHIFT;
    vec4 place = place_at(surface_places, i);
    if ((side & SIDE_PLANE) != 0u || SOLIDS_HAVE == SURFACE_PLANE) return place.xyz;
    return surface_gradient(surface_at(surfaces, i), ray.o + t * ray.d - place.xyz);
}

// The side that the ray meets at depth t.
Side side_at(uint side, float t, Ray ray) {
    if (!SOLIDS_HAVE_BOUNDARY_OPERANDS || side < frame.side_count) {
        LeafSurface s = leaf_surface_at(leaf_surfaces, side);
        return Side(s.leaf, across_side(s.surface, t, ray), s.surface >> SIDE_SHIFT);
    }
    uint triangle = side - frame.side_count;
    OperandMesh mesh = mesh_of(triangle);
    uint plane = plane_of(mesh, triangle);
    if (plane != NO_PLANE) return Side(mesh.leaf, place_at(surface_places, plane).xyz, plane);
    return Side(mesh.leaf, instances[mesh.instance].normal * facet_normal(triangle), OWN_PLANE | triangle);
}

#endif
