// The point of the exact surface under a pixel with its normal, where it has none of its own, too. Needs scene.glsl and
// refine.glsl.
#ifndef PATCH_NORMAL_GLSL
#define PATCH_NORMAL_GLSL

const float FIRST_INWARDS = 1e-3; // of the way to the patch's middle
const float MOST_INWARDS = 0.3;

// What `refine` finds, and S_u x S_v there, or where it vanishes (pole, collapsed side) its limit from the patch's inside.
// One evaluation, in one loop: a rasterizer in software runs what no pixel asks for once, too. For fragments: their groups
// are the same in every frame, where those of compute shaders may not be (refine.glsl says what that does).
Sample refine_with_normal(Patch patch_, View view, vec2 uv, vec2 pixel, out vec3 normal) {
    Sample best;
    vec2 next = uv;
    uint steps = 0u;
    float inwards = 0.0; // found: the normal is looked for
    bool found = false;
    while (!found) {
        Sample here = sample_at(patch_, view, next, pixel);
        Jet jet = here.jet;
        bool goes_on = false;
        if (inwards == 0.0) {
            bool nearer = steps == 0u || dot(here.miss, here.miss) < dot(best.miss, best.miss);
            if (nearer) best = here;
            vec2 step_;
            goes_on = step_from(best, view, step_) && nearer && steps < NEWTON_STEPS;
            ++steps;
            next = best.uv - step_;
            jet = best.jet;
        }
        if (!goes_on) {
            normal = cross(jet.du, jet.dv);
            float size = dot(best.jet.du, best.jet.du) + dot(best.jet.dv, best.jet.dv);
            inwards = inwards == 0.0 ? FIRST_INWARDS : 4.0 * inwards;
            found = dot(normal, normal) >= 1e-10 * size * size || inwards >= MOST_INWARDS;
            next = mix(best.uv, vec2(0.5), inwards);
        }
    }
    return best;
}

#endif
