#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `blister`: the nearest face of a leaf behind the previous layer. The depth test finds the nearest of all leaves.
//
//      ray ──┼────────┬────────┬─────▶
//   leaf     │    ├───┤████████├───      a leaf that adds shows where the ray enters it, a leaf that subtracts
//            │        ▲                  where the ray leaves it: a solid begins only there
//      layer before
#include "scene.glsl"
#include "solids.glsl"
#include "eye_ray.glsl"
#include "blister.glsl"
#include "visible.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(binding = 2) uniform usamplerBuffer leaf_surfaces;
layout(binding = 3) uniform samplerBuffer surfaces;
layout(binding = 4) uniform samplerBuffer surface_places;
layout(binding = 5, rg32ui) readonly uniform uimage2D before;
layout(binding = 6, rg32ui) readonly uniform uimage2D found;

layout(location = 0) flat in uint own;
layout(location = 0) out uvec2 layer;

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uvec2 from = imageLoad(before, pixel).xy;
    if (from.x == 0u) discard;
    if ((asked & PEEL_UNLOCKS) == 0u && imageLoad(found, pixel).x != 0u) discard; // locked
    float behind = uintBitsToFloat(from.y);
    Leaf leaf = leaves[own];
    Ray ray = eye_ray(frame, gl_FragCoord.xy);
    bool entries = (asked & ((leaf.flags & LEAF_NEGATIVE) != 0u ? PEEL_EXITS : PEEL_ENTRIES)) != 0u;
    Span s = EVERYTHING;
    float t = NEVER;
    uint side = 0u;
    // the surfaces twice: first the part inside all of them, then the surface that ends there
    for (uint i = 0u; i < 2u * leaf.count; ++i) {
        if (i == leaf.count) {
            float first = entries ? s.lo : s.g0;
            float second = entries ? s.g1 : s.hi;
            bool gap = s.g0 < s.g1;
            bool first_counts = entries || gap;
            bool second_counts = !entries || gap;
            if (second_counts && second > behind) t = second;
            if (first_counts && first > behind) t = first;
            if (!(s.lo < s.hi) || !(t < frame.far)) break;
        }
        uint k = leaf.first + i % leaf.count;
        Span one = side_span(surfaces, surface_places, side_word(leaf_surfaces, k), ray.o, ray.d);
        if (i >= leaf.count && ends_at(one, t)) side = k;
        if (i < leaf.count) s = both(s, one);
    }
    if (!(s.lo < s.hi) || !(t < frame.far)) discard;
    layer = uvec2(SEEN_SOLID | side, floatBitsToUint(t));
    gl_FragDepth = layer_depth(frame, t);
}
