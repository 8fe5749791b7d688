// Whether a point is within the volume that trims the scene's faces and meshes (Model::trim_by). The includer declares
// `frame` and defines VOLUME_BINDING, the first of four buffers.
//
//   point ──▶ leaf: behind all its sides? ──in or out exit──▶ leaf … ──▶ EXIT_TRUE: visible
//
// Exits lead forward, so the walk ends. Points on the volume's boundary count as within it: leaves that add are
// enlarged by a point's possible error, and leaves that subtract are reduced by it.
#ifndef VOLUME_GLSL
#define VOLUME_GLSL

#include "solids.glsl"
#include "eye_ray.glsl"

layout(scalar, binding = VOLUME_BINDING + 0) readonly buffer VolumeLeaves { Leaf volume_leaves[]; };
layout(binding = VOLUME_BINDING + 1) uniform usamplerBuffer volume_sides;
layout(binding = VOLUME_BINDING + 2) uniform samplerBuffer volume_surfaces;
layout(binding = VOLUME_BINDING + 3) uniform samplerBuffer volume_places;

// A point this near to the boundary counts as on it: in pixels, far below any tolerance, and as a share of the depth,
// above the rounding of a point relative to the eye.
const float ON_PX = 0.01;
const float ON_DEPTH = 2e-6;

// Whether p is behind all sides of the leaf, or at most `slack` before them; p is relative to the eye.
bool in_leaf(Leaf leaf, vec3 p, float slack) {
    bool inside = true;
    for (uint k = leaf.first; k < leaf.first + leaf.count && inside; ++k) {
        uint word = side_word(volume_sides, k);
        vec4 place = place_at(volume_places, word >> SIDE_SHIFT);
        float value = dot(place.xyz, p) - place.w;
        float slope = 1.0; // growth of the function per unit of length
        if ((word & SIDE_PLANE) == 0u && SOLIDS_HAVE != SURFACE_PLANE) {
            Surface s = surface_at(volume_surfaces, word >> SIDE_SHIFT);
            value = surface_value(s, p - place.xyz);
            slope = 2.0 * length(surface_gradient(s, p - place.xyz));
        }
        inside = ((word & SIDE_NEGATIVE) != 0u ? -value : value) <= slack * slope;
    }
    return inside;
}

// Whether the point is within the volume, or at most `margin_px` from it; `q` is a homogeneous pixel with the depth
// third.
bool in_volume(vec4 q, float margin_px) {
    Ray ray = eye_ray(frame, q.xy / q.w);
    vec3 p = ray.o + q.z * ray.d;
    float unit = (frame.perspective != 0u ? q.z : 1.0) / frame.focal; // of a pixel there
    float on = margin_px * unit + ON_DEPTH * abs(q.z);
    uint at = 0u;
    for (;;) {
        Leaf leaf = volume_leaves[at];
        bool inside = in_leaf(leaf, p, (leaf.flags & LEAF_NEGATIVE) != 0u ? -on : on);
        uint next = inside ? leaf.in_exit : leaf.out_exit;
        // inactive lanes read zeros
        if (next <= at || next >= EXIT_FALSE) return next == EXIT_TRUE;
        at = next;
    }
}

#endif
