// The outputs of pass `resolve`, for every kind of surface. Needs `frame`, scene.glsl, view.glsl.
#ifndef RESOLVED_GLSL
#define RESOLVED_GLSL

#include "eye_ray.glsl"
#include "shade.glsl"
#include "curvature.glsl"

// The surface number of points on no known surface of a Boolean solid. It has the bit of OWN_PLANE, like a triangle
// without a shared plane.
const uint NO_SURFACE = 0xffffffffu;

#ifdef SUN_BINDING
#include "sun.glsl"
#endif

layout(constant_id = 3) const bool HAS_AOVS = false;

// The image behind layers of pass `solid_layers`: linear colour, with the depth beside it.
layout(constant_id = 18) const bool BEHIND = false;

layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_face;
layout(location = 3) out vec2 out_uv;
layout(location = 4) out vec4 out_normal;

// The light of a point, and whether the sun contributes.
struct Lit {
    vec3 light;
    float sun;
};

// The light of a point at a depth of the pixel's ray, with unit outward normal `n` in model space; `surface` is the
// number of the Boolean solids' surface that contains it, or NO_SURFACE.
Lit lit_at(vec3 colour, vec3 n, bool two_sided, Ray ray, float depth, uint surface) {
#ifdef SUN_BINDING
    vec3 seen = two_sided && dot(n, ray.d) > 0.0 ? -n : n;
    bool reached = in_sun(ray, depth, seen, surface);
    return Lit(shade_in_sun(colour, seen, frame, sun.towards, reached, ray.d), reached ? 1.0 : 0.0);
#else
    return Lit(shade(colour, n, frame, two_sided, ray.d), 1.0);
#endif
}

// Writes a point of a surface, with arguments as in `lit_at`. `own` is the surface's colour; the instance's is over it.
// `curvature` is against `n`, and is used if `shows_curvature`.
void write_surface(
    uint own, Instance instance, vec3 n, bool solid, float depth, uint id, vec2 uv, uint surface, Curvature curvature
) {
    vec4 placed = unpackUnorm4x8(instance.colour);
    vec4 under = unpackUnorm4x8(own);
    vec4 colour = placed.a < 1.0 ? mix(under, placed, placed.a) : placed;
    Ray ray = eye_ray(frame, gl_FragCoord.xy);
    Lit at = lit_at(colour.rgb, n, !solid, ray, depth, surface);
    vec3 lit = at.light;
    if (shows_curvature()) {
        vec3 v = in_view(frame, n);
        if (!solid && dot(n, ray.d) > 0.0) {
            curvature.mean = -curvature.mean;
            v = -v;
        }
        lit = curvature_colour(curvature, v);
    }
    out_colour = BEHIND ? vec4(clamp(lit, 0.0, 1.0), depth) : encode(vec4(lit, 1.0), frame.encode_srgb);
    if (HAS_AOVS) {
        out_depth = depth;
        out_face = id;
        out_uv = uv;
        out_normal = vec4(n, at.sun);
    }
    gl_FragDepth = reversed_depth(frame, depth) / (frame.perspective != 0u ? depth : 1.0);
}

#endif
