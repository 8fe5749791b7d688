// Patches of closed parts without trims that are turned away from the viewer: nearer patches hide them. Twin of
// src/twin/cone.rs, which has the derivation. Needs scene.glsl and view.glsl.
#ifndef CONE_GLSL
#define CONE_GLSL

// Rounding of the eye's distance.
const float EYE_ROUNDING = 1e-5;

float times(vec3 a, vec3 b) {
    precise float sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
}

vec3 across(vec3 a, vec3 b) {
    precise vec3 c = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
    return c;
}

// `cone`: the axis of the outward normals, as long as the part's radius, 0 without a cone; the sine of half its angle.
bool looks_away(View view, Frame frame, Patch patch_, vec4 cone) {
    precise float radius = sqrt(times(cone.xyz, cone.xyz));
    precise float reach = radius * sqrt(times(view.depth.xyz, view.depth.xyz));
    if (radius == 0.0 || view.depth.w - reach < frame.near) return false;
    vec3 xy = across(view.x.xyz, view.y.xyz);
    if (frame.perspective == 0u) {
        float towards = times(xy, view.depth.xyz) < 0.0 ? -1.0 : 1.0;
        precise float least = radius * cone.w * sqrt(times(xy, xy));
        return towards * times(xy, cone.xyz) >= least;
    }
    vec3 yw = across(view.y.xyz, view.w.xyz);
    vec3 wx = across(view.w.xyz, view.x.xyz);
    precise vec3 eye = -(view.x.w * yw + view.y.w * wx + view.w.w * xy) / times(view.x.xyz, yw);
    precise vec3 middle = 0.5 * (patch_.box_min + patch_.box_max);
    precise vec3 half_ = 0.5 * (patch_.box_max - patch_.box_min);
    precise vec3 ray = middle - eye;
    precise float around = sqrt(times(half_, half_)) + EYE_ROUNDING * sqrt(times(eye, eye));
    precise float least = radius * (cone.w * sqrt(times(ray, ray)) + around);
    return times(ray, cone.xyz) >= least;
}

#endif
