// The point of the exact surface under a pixel with its normal, where it has none of its own, too. Needs scene.glsl and
// refine.glsl.
#ifndef PATCH_NORMAL_GLSL
#define PATCH_NORMAL_GLSL

const float FIRST_INWARDS = 1e-3; // of the way to the patch's middle
const float MOST_INWARDS = 0.3;

// S_u x S_v, or where it vanishes (pole, collapsed side) its limit from the patch's inside. In the loop of the search, for
// the reason that stands there.
Sample refine_with_normal(Patch patch_, View view, vec2 uv, vec2 pixel, out vec3 normal) {
    Search search = search_from(uv);
    float inwards = 0.0; // found: the normal is looked for
    bool found = false;
    while (!found) {
        Sample here = sample_at(patch_, view, search.next, pixel);
        bool searches = inwards == 0.0 && goes_on(search, here, view);
        if (!searches) {
            Jet own = search.best.jet;
            Jet jet = inwards == 0.0 ? own : here.jet;
            normal = cross(jet.du, jet.dv);
            float size = dot(own.du, own.du) + dot(own.dv, own.dv);
            inwards = inwards == 0.0 ? FIRST_INWARDS : 4.0 * inwards;
            found = dot(normal, normal) >= 1e-10 * size * size || inwards >= MOST_INWARDS;
            search.next = mix(search.best.uv, vec2(0.5), inwards);
        }
    }
    return search.best;
}

#endif
