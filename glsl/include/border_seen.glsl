// What the points of a pixel at a border see. In scenes with meshes or Boolean solids one pass asks the patches, one the
// meshes and one the solids, and each keeps what is nearest; else pass `border_mix` asks the patches and makes the mean,
// or pass `border_followed` does. Needs `frame`, `resolved`, visible.glsl, shade.glsl and unmixed.glsl.
#ifndef BORDER_SEEN_GLSL
#define BORDER_SEEN_GLSL

#include "border_around.glsl"

// Colour of point `k`, for which the pixel `shown` has one. `unasked`: bits of the pixels around that see what no point was
// asked for. `sliver`: of the pixel in the list.
vec4 shown_at(ivec2 at, uint k, uint shown, uint unasked, uint sliver) {
    if (shown == NOBODY) shown = nearest_of(unasked, point_of(k));
    if (shown == NOBODY) shown = OWN; // a gap between faces
    return unmixed_at(around_or_far(at, shown, sliver));
}

uvec2 packed_mean(vec4 sum) {
    sum /= float(BORDER_POINTS);
    return uvec2(packHalf2x16(sum.rg), packHalf2x16(sum.ba));
}

#endif
