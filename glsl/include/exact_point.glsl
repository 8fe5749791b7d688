// The exact point of a fragment, for the volume that trims the scene. Its pixel differs from the fragment's by the
// tessellation's deviation. The includer defines VOLUME_BINDING and declares `frame`.
#ifndef EXACT_POINT_GLSL
#define EXACT_POINT_GLSL

#include "view.glsl"


#include "patch.glsl"
#include "volume.glsl"

vec4 exact_point(Patch patch_, View view, vec2 uv) {
    return to_pixel(view, vec4(patch_jet(patch_.first, patch_.shape, uv).point, 1.0));
}

#endif
