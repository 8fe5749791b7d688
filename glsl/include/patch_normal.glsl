// The normal of a patch, where it has none of its own, too. Needs scene.glsl and patch.glsl.
#ifndef PATCH_NORMAL_GLSL
#define PATCH_NORMAL_GLSL

// S_u x S_v, or where it vanishes (pole, collapsed side) its limit from the patch's inside.
vec3 normal_of(Patch patch_, Jet jet, vec2 uv) {
    vec3 n = cross(jet.du, jet.dv);
    float size = dot(jet.du, jet.du) + dot(jet.dv, jet.dv);
    for (float step_ = 1e-3; step_ < 0.3 && dot(n, n) < 1e-10 * size * size; step_ *= 4.0) {
        Jet inner = patch_jet(patch_.first, patch_.shape, mix(uv, vec2(0.5), step_));
        n = cross(inner.du, inner.dv);
    }
    return n;
}

#endif
