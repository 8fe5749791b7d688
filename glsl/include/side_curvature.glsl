// Curvature of the sides of Boolean solids, from gradient and second derivatives of their functions. Needs sides.glsl
// and curvature.glsl.
#ifndef SIDE_CURVATURE_GLSL
#define SIDE_CURVATURE_GLSL

// Second derivatives of the function whose gradient is `surface_gradient`, model axes. Symmetric.
mat3 surface_bend(Surface s, vec3 p) {
    vec3 q = s.to_local * p;
    mat3 local;
    if (SOLIDS_HAVE == SURFACE_TORUS && s.is_torus) {
        float rho = max(length(q.xy), 1e-20);
        vec2 out_ = q.xy / rho;
        float rest = 1.0 / rho;
        local = mat3(
            vec3(1.0 - rest + rest * out_.x * out_.x, rest * out_.x * out_.y, 0.0),
            vec3(rest * out_.x * out_.y, 1.0 - rest + rest * out_.y * out_.y, 0.0), vec3(0.0, 0.0, 1.0)
        );
    } else {
        local = mat3(vec3(s.squares.x, 0.0, 0.0), vec3(0.0, s.squares.y, 0.0), vec3(0.0, 0.0, s.squares.z));
    }
    return transpose(s.to_local) * local * s.to_local;
}

// Curvature of a side that the ray meets at depth t. Planes and triangles have none.
Curvature side_curvature(uint side, float t, Ray ray) {
    if (SOLIDS_HAVE == SURFACE_PLANE || SOLIDS_HAVE_BOUNDARY_OPERANDS && side >= frame.side_count) return NO_CURVATURE;
    uint word = leaf_surface_at(leaf_surfaces, side).surface;
    if ((word & SIDE_PLANE) != 0u) return NO_CURVATURE;
    Surface s = surface_at(surfaces, word >> SIDE_SHIFT);
    vec3 p = ray.o + t * ray.d - place_at(surface_places, word >> SIDE_SHIFT).xyz;
    vec3 g = surface_gradient(s, p);
    mat3 bend = surface_bend(s, p);
    float steep = dot(g, g);
    if (!(steep > 0.0)) return NO_CURVATURE; // the tip of a cone
    float trace = bend[0].x + bend[1].y + bend[2].z;
    float mean = 0.5 * (steep * trace - dot(g, bend * g)) / (steep * sqrt(steep));
    mat3 adjugate = mat3(cross(bend[1], bend[2]), cross(bend[2], bend[0]), cross(bend[0], bend[1]));
    return Curvature(dot(g, ray.d) > 0.0 ? -mean : mean, dot(g, adjugate * g) / (steep * steep));
}

#endif
