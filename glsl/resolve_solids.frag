#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`, pixels of Boolean solids: normal and light of the side that pass `solid_events` found.
// The depth there is exact already.
#include "scene.glsl"
#include "solids.glsl"
#include "eye_ray.glsl"

layout(constant_id = 3) const bool HAS_AOVS = false;

layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(scalar, binding = 2) readonly buffer LeafSurfaces { LeafSurface leaf_surfaces[]; };
layout(scalar, binding = 3) readonly buffer Surfaces { Surface surfaces[]; };
layout(scalar, binding = 4) readonly buffer SurfaceCentres { vec3 surface_centres[]; };
layout(binding = 5, rg32ui) readonly uniform uimage2D visibility;

#include "visible.glsl"
#include "shade.glsl"

layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_face;
layout(location = 3) out vec2 out_uv;
layout(location = 4) out vec4 out_normal;

void main() {
    uvec2 seen = imageLoad(visibility, ivec2(gl_FragCoord.xy)).xy;
    if (!sees_solid(seen.x)) discard;
    LeafSurface side = leaf_surfaces[seen_side(seen.x)];
    uint at = side.surface >> 1;
    Leaf leaf = leaves[side.leaf];
    float t = uintBitsToFloat(seen.y);
    Ray ray = eye_ray(frame, gl_FragCoord.xy);
    vec3 n = normalize(surface_gradient(surfaces[at], ray.o + t * ray.d - surface_centres[at]));
    // the solid begins here: its outside is before
    if (dot(n, ray.d) > 0.0) n = -n;
    vec4 colour = unpackUnorm4x8(leaf.colour);
    out_colour = encode(vec4(shade(colour.rgb, n, frame, false), 1.0), frame.encode_srgb);
    if (HAS_AOVS) {
        out_depth = t;
        out_face = leaf.id;
        out_uv = vec2(uintBitsToFloat(0x7fc00000u));
        out_normal = vec4(n, 1.0);
    }
    gl_FragDepth = reversed_depth(frame, t);
}
