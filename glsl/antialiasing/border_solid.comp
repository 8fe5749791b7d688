#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `border_solid`: tests the points of pixels at borders against the Boolean solids, by the whole expression. Each
// point has a ray of its own, as pass `solid_events` has for the centre, among the leaves of the pixel's tile. One
// thread a point; those of a pixel run together, and meet the same leaves.
//
// A point shows the pixel around that sees the same side nearest to the point's depth: a side may hide itself. Where
// none does, it shows the nearest pixel that sees a solid.
#include "scene.glsl"
#include "solids.glsl"
#include "boundary_operands.glsl"
#include "tiles.glsl"
#include "eye_ray.glsl"
#include "view.glsl"
#include "visible.glsl"
#include "words.glsl"
#include "shade.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(binding = 2) uniform usamplerBuffer leaf_surfaces;
layout(binding = 3) uniform samplerBuffer surfaces;
layout(binding = 4) uniform samplerBuffer surface_places;
layout(binding = 5) uniform usamplerBuffer tile_starts;
layout(binding = 6) uniform usamplerBuffer tile_leaves;
layout(binding = 7) uniform usamplerBuffer tile_entries;
layout(binding = 8) uniform usamplerBuffer fragments; // not read: no leaf is a boundary operand
layout(binding = 9, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 10, rg32ui) readonly uniform uimage2D meshes_and_solids; // in scenes without trims the same
layout(binding = 11, rgba32f) readonly uniform image2D resolved;
#include "border_pixel.glsl"
#include "unmixed.glsl"
#include "border_seen.glsl"
layout(scalar, binding = 12) readonly buffer List { BorderPixel list[]; };
layout(scalar, binding = 13) readonly buffer Grids { BorderGrids grids; };
layout(scalar, binding = 14) buffer SeenPoints { BorderPoint seen_points[]; };

// No pass has sampled the points before: there are neither patches nor meshes.
layout(constant_id = 38) const bool ASKS_FIRST = false;
const bool SOLIDS_HAVE_BOUNDARY_OPERANDS = false;

#include "crossing.glsl"
#include "leaf_span.glsl"
#include "solid_walk.glsl"

// Which pixel around shows the side at depth `t`, to point `k`; NOBODY where none sees a solid.
uint shows(ivec2 at, uint k, uint side, float t) {
    uint shown = NOBODY;
    uint solid = 0u; // bits of pixels
    float least = UNSEEN;
    for (uint from = 0u; from < AROUND; ++from) {
        ivec2 beside = around(at, from);
        if (!is_in_picture(beside)) continue;
        uvec2 word = imageLoad(visibility, beside).xy;
        if (sees_nothing(word.x)) word = imageLoad(meshes_and_solids, beside).xy;
        if (!sees_solid(word.x)) continue;
        solid |= 1u << from;
        float off = abs(uintBitsToFloat(word.y) - t);
        if (seen_side(word.x) != side || !(off < least)) continue;
        least = off;
        shown = from;
    }
    return shown == NOBODY ? nearest_of(solid, point_of(k)) : shown;
}

void main() {
    uint thread = thread_number();
    uint n = thread / BORDER_POINTS;
    if (n >= grids.count) return;
    uint k = thread % BORDER_POINTS;
    ivec2 at = pixel_of(list[n]);
    BorderPoint seen = BorderPoint(UNSEEN, NOBODY);
    if (!ASKS_FIRST) seen = seen_points[thread];
    Meets meets = leaves_at(uvec2(at));
    Progress p = begin_walk();
    if (meets.entry != EXIT_FALSE) follow(p, meets, eye_ray(frame, vec2(at) + 0.5 + point_of(k)));
    if (p.done && p.t < seen.depth) seen = BorderPoint(p.t, shows(at, k, p.side, p.t));
    seen_points[thread] = seen;
}
