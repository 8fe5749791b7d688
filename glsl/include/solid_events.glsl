// Passes `solid_events` and, with FACE_IS_FOUND, `blister`: find the first depth at which the pixel's ray enters the
// Boolean solid.
//
//      ray ──┬──────────┬────┬─────────┬──▶     events: where the ray crosses a side of some leaf
//   A     ───┤██████████│████├─────────┼──
//   B     ───┼──────────┤████│█████████├──      coinciding sides share their surface, so their
//            ▲          ▲    ▲         ▲        depths are equal to the bit and make one event
//         in A?    the Blist is walked once behind each event
//
// The ray is followed from the near plane until outside becomes inside. A near plane within the solid cuts it open;
// then the first side entered from there is visible. Only the spans of the tile's first leaves are stored. Exits of a
// Blist lead forward, so one scan over the leaves decides both whether the solid is behind depth t and where the next
// relevant event is. The surfaces' equations are in one loop of their own, which skips stored spans: a driver that runs
// both sides of every branch does not solve them again. If the depth of the face is already known, the walk begins
// there and finds its owner.
//
// A driver may end a long loop early. Such a ray resumes from its last event when the same pass is drawn again: in
// segments. There are several segments only after a frame has reported that it needs them.
//
// An event is relevant only if it belongs to a leaf that the walk tests: until then the walk ends at the same leaf,
// whatever the other leaves are. In A - (B + C + ...) no other leaf is tested before A begins. While a gate of the
// tile's list is shut, only the gate is relevant: in (A + B + ...) - C the next event within C is its end.
#ifndef SOLID_EVENTS_GLSL
#define SOLID_EVENTS_GLSL

#include "scene.glsl"
#include "solids.glsl"
#include "boundary_operands.glsl"
#include "tiles.glsl"
#include "eye_ray.glsl"
#include "view.glsl"
#include "visible.glsl"
#include "words.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(binding = 2) uniform usamplerBuffer leaf_surfaces;
layout(binding = 3) uniform samplerBuffer surfaces;
layout(binding = 4) uniform samplerBuffer surface_places;
layout(binding = 5) uniform usamplerBuffer tile_starts;
layout(binding = 6) uniform usamplerBuffer tile_leaves;
layout(binding = 7) uniform usamplerBuffer tile_entries;

layout(scalar, binding = 8) readonly buffer FragmentStarts { uint fragment_starts[]; };
layout(scalar, binding = 9) readonly buffer FragmentCounts { uint fragment_counts[]; };
layout(binding = 10) uniform usamplerBuffer fragments;

layout(scalar, binding = 11) buffer CountersBuffer { Counters counters; };

#ifdef FACE_IS_FOUND
layout(binding = 12, rg32ui) readonly uniform uimage2D found;
#endif

#ifndef FACE_IS_FOUND
layout(scalar, binding = 13) buffer ResumePoints { uint resume_points[]; }; // of each pixel; bound if there are several ray segments
layout(scalar, push_constant) uniform Legs {
    uint nth;     // this segment, from 0
    uint ray_segments;    // of this drawing
    uint is_most; // a frame may not request more
};

// A resume point: the depth of the event from which the next segment continues, with the sign bit set if the solid is
// in front of it; 0 if the ray is finished.
const uint RESUME_BEFORE = 0x80000000u;
#endif

// Whether some leaf is a boundary operand; the code for boundary operands is compiled in only then.
layout(constant_id = 13) const bool SOLIDS_HAVE_BOUNDARY_OPERANDS = true;

#include "crossing.glsl"
#include "leaf_span.glsl"
#include "solid_walk.glsl"

layout(location = 0) out uvec2 visible;
layout(location = 1) out uint operand_uv; // of a spline face, in scenes with spline operands

void main() {
    uint pixel = pixel_in_band(frame, uvec2(gl_FragCoord.xy));
#ifndef FACE_IS_FOUND
    uint resume_point = 0u;
    if (nth > 0u) {
        resume_point = resume_points[pixel];
        if (resume_point == 0u) discard;
    }
#endif
    Meets meets = leaves_at(uvec2(gl_FragCoord.xy));
    if (meets.entry == EXIT_FALSE) discard;
    meets.first_fragment = SOLIDS_HAVE_BOUNDARY_OPERANDS ? fragment_starts[pixel] : 0u;
    meets.fragment_count = SOLIDS_HAVE_BOUNDARY_OPERANDS ? fragment_counts[pixel] : 0u;
    Progress p = begin_walk();
#ifdef FACE_IS_FOUND
    uvec2 face = imageLoad(found, ivec2(gl_FragCoord.xy)).xy;
    if (face.x == 0u) discard;
    p.t = uintBitsToFloat(face.y);
    p.before = false;
#else
    if (nth > 0u) {
        p.before = (resume_point & RESUME_BEFORE) != 0u;
        p.t = uintBitsToFloat(resume_point & ~RESUME_BEFORE);
    }
    float begun = p.t;
    bool begun_before = p.before;
#endif
    follow(p, meets, eye_ray(frame, gl_FragCoord.xy));
    bool ended = p.done || p.passed;
#ifdef FACE_IS_FOUND
    if (!ended) atomicAdd(counters.clamps, 1u);
#else
    // resume from the event of the last valid scan, if it is farther on
    bool goes_on = !ended && (p.t > begun || p.t == begun && p.before != begun_before);
    if (goes_on) atomicMax(counters.ray_segments, nth + 1u);
    if (ray_segments > 1u) resume_points[pixel] = goes_on ? floatBitsToUint(p.t) | (p.before ? RESUME_BEFORE : 0u) : 0u;
    if (goes_on && nth + 1u == ray_segments && is_most == 0u) atomicOr(counters.failed, FAILED_RAY_SEGMENTS);
    else if (!ended && (!goes_on || nth + 1u == ray_segments)) atomicAdd(counters.clamps, 1u);
#endif
    if (!p.done) discard;
    operand_uv = p.operand_uv;
    visible = uvec2(p.word | p.side, floatBitsToUint(p.t));
    gl_FragDepth = reversed_depth(frame, p.t) / (frame.perspective != 0u ? p.t : 1.0);
}

#endif
