#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `operand_mesh`: a ray crosses a triangle of an operand. The depth is that of the triangle's plane.
#include "scene.glsl"
#include "solids.glsl"
#include "eye_ray.glsl"
#include "shells.glsl"

layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(scalar, binding = 5) readonly buffer LeafSurfaces { LeafSurface leaf_surfaces[]; };
layout(scalar, binding = 6) readonly buffer Surfaces { Surface surfaces[]; };
layout(scalar, binding = 7) readonly buffer SurfaceCentres { vec3 surface_centres[]; };
layout(scalar, binding = 8) buffer FragmentCounts { uint fragment_counts[]; };
layout(scalar, binding = 9) readonly buffer FragmentStarts { uint fragment_starts[]; };
layout(scalar, binding = 10) writeonly buffer Fragments { Fragment fragments[]; };

#include "put_fragment.glsl"
#include "triangle_depth.glsl"

layout(location = 0) flat in uvec3 crossed;
layout(location = 1) flat in vec2 range;

void main() {
    float depth = 0.0;
    if (FILLS) depth = triangle_depth(eye_ray(frame, gl_FragCoord.xy), crossed.y, range);
    bool leaves = gl_FrontFacing == (crossed.z != 0u);
    put_fragment(Fragment(crossed.x | (leaves ? FRAGMENT_LEAVES : 0u), depth, crossed.y, 0u));
}
