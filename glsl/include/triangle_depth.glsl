// Where a ray meets the plane of an operand's triangle, by the formula of the other solids' sides: faces that
// coincide are met at the same depth, bit for bit. Needs solids.glsl, eye_ray.glsl, and buffers `LeafSurface
// leaf_surfaces[]`, `Surface surfaces[]`, `vec3 surface_centres[]`.
#ifndef TRIANGLE_DEPTH_GLSL
#define TRIANGLE_DEPTH_GLSL

// A plane seen edge-on is met anywhere: not farther from the corners than they are from each other, and
// some roundings of a depth.
const float ROUNDING = 4e-6;

// `range`: of the corners' depths.
float triangle_depth(Ray ray, uint side, vec2 range) {
    uint surface = leaf_surfaces[side].surface >> 1;
    precise vec3 o = ray.o - surface_centres[surface];
    Span s = surface_span(surfaces[surface], o, ray.d);
    float reach = range.y - range.x + ROUNDING * range.y;
    return clamp(s.lo > -NEVER ? s.lo : s.hi, range.x - reach, range.y + reach);
}

#endif
