// The intersection of a ray with the plane of an operand's triangle. A plane shared with other faces is intersected by
// the formula for the solids' other sides, so that coinciding faces have the same depth, bit for bit. Otherwise the
// corners give the plane, and the depth is kept within the triangle, as for other meshes. Needs scene.glsl,
// solids.glsl, boundary_operands.glsl, eye_ray.glsl, `frame`, and the buffers of facet.glsl, `View views[]`, `uint
// planes[]`, `samplerBuffer surfaces`, `samplerBuffer surface_places`.
#ifndef TRIANGLE_DEPTH_GLSL
#define TRIANGLE_DEPTH_GLSL

#include "facet.glsl"

// A plane nearly parallel to the ray is met at an arbitrary depth, which is clamped to the corners' depths, enlarged by
// their range and some roundings of a depth.
const float ROUNDING = 4e-6;

uint plane_of(OperandMesh mesh, uint triangle) {
    return mesh.first_plane == NO_PLANE ? NO_PLANE : planes[mesh.first_plane + triangle - mesh.first_triangle];
}

float triangle_depth(OperandMesh mesh, uint triangle, vec2 pixel) {
    View view = views[mesh.instance];
    uint plane = plane_of(mesh, triangle);
    if (plane == NO_PLANE) return facet_at(triangle, view, pixel).depth;
    vec3 depths;
    for (uint k = 0u; k < 3u; ++k) depths[k] = row_times(view.depth, vec4(positions[triangles[3u * triangle + k]], 1.0));
    float nearest = min(depths.x, min(depths.y, depths.z));
    float farthest = max(depths.x, max(depths.y, depths.z));
    Ray ray = eye_ray(frame, pixel);
    float t = plane_depth(place_at(surface_places, plane), ray.o, ray.d);
    float reach = farthest - nearest + ROUNDING * farthest;
    // a ray within the plane does not meet it
    return isnan(t) ? farthest + reach : clamp(t, nearest - reach, farthest + reach);
}

#endif
