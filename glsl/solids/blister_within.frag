#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `blister`: whether the point behind the layer's face is within a leaf. Other pixels are discarded; the stencil
// test marks the rest.
#include "scene.glsl"
#include "solids.glsl"
#include "eye_ray.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(binding = 2) uniform usamplerBuffer leaf_surfaces;
layout(binding = 3) uniform samplerBuffer surfaces;
layout(binding = 4) uniform samplerBuffer surface_places;
layout(binding = 5, rg32ui) readonly uniform uimage2D layer;

layout(location = 0) flat in uint own;

void main() {
    uvec2 face = imageLoad(layer, ivec2(gl_FragCoord.xy)).xy;
    if (face.x == 0u) discard;
    float t = uintBitsToFloat(face.y);
    Leaf leaf = leaves[own];
    Ray ray = eye_ray(frame, gl_FragCoord.xy);
    bool inside = true;
    for (uint k = leaf.first; k < leaf.first + leaf.count && inside; ++k) {
        uint surface = side_word(leaf_surfaces, k);
        inside = inside_span(side_span(surfaces, surface_places, surface, ray.o, ray.d), t);
    }
    if (!inside) discard;
}
