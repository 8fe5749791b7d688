// Pass `border_mesh`: the points of pixels at borders ask the meshes that the nine pixels around see. One thread a
// pixel of the list.
//
//     ╲       ╱╲       a triangle that a pixel around sees covers a point; else the mesh is followed from it to the point's
//      ╲  ○──╱──╲──▶·  ray, across the side that the ray passes farthest beyond. It is not there where a border or a fold
//       ╲  ╱      ╲    comes first. Nobody walks to where a nearer triangle than the plane of its own is known
//
// A point shows the pixel that sees its triangle; else that whose triangle lies most as that one does.
#include "scene.glsl"
#include "view.glsl"
#include "visible.glsl"
#include "shade.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Views { View views[]; };
layout(scalar, binding = 2) readonly buffer MeshInstances { MeshInstance mesh_instances[]; };
layout(scalar, binding = 3) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 4) readonly buffer Positions { vec3 positions[]; };
layout(scalar, binding = 5) readonly buffer Neighbours { uint neighbours[]; };
layout(binding = 6, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 7, rg32ui) readonly uniform uimage2D meshes_and_solids; // in scenes without trims the same
layout(binding = 8, rgba32f) readonly uniform image2D resolved;
#include "border_pixel.glsl"
#include "unmixed.glsl"
#include "border_seen.glsl"
layout(scalar, binding = 9) readonly buffer List { BorderPixel list[]; };
layout(scalar, binding = 10) readonly buffer Grids { BorderGrids grids; };
layout(scalar, binding = 11) buffer SeenPoints { BorderPoint seen_points[]; };
#ifdef WITHIN_VOLUME
#define VOLUME_BINDING 12
#include "volume.glsl"
#endif

// No pass has asked before: there are no patches.
layout(constant_id = 38) const bool ASKS_FIRST = false;

// Less than JUMP_PX, at which a walk ends at once: what differs by rounding alone is left to the walk.
const float LEADS_NOWHERE_PX = 1.5;

#include "facet.glsl"
#include "mesh_walk.glsl"

// A triangle that a pixel around sees.
struct Start {
    uvec2 word; // of the visibility image
    uint from;
    vec3 n;     // of unit length
    uint walks; // bits of points to which it may lead
};

vec3 unit_normal(uint triangle) {
    vec3 n = facet_normal(triangle);
    return n * inversesqrt(max(dot(n, n), 1e-36));
}

bool is_shown(float depth, vec2 pixel) {
    bool is = depth >= frame.near && depth <= frame.far;
#ifdef WITHIN_VOLUME
    precise float w = frame.perspective != 0u ? depth : 1.0;
    is = is && in_volume(vec4(pixel * w, depth, w), ON_PX);
#endif
    return is;
}

// Depths of less before another are not told from it by planes that go on beyond their triangles.
float before(float depth, float jump_px) {
    return depth >= UNSEEN ? depth : depth - jump_px * (frame.perspective != 0u ? depth : 1.0) / frame.focal;
}

void main() {
    uint n = thread_number();
    if (n >= grids.count) return;
    ivec2 at = pixel_of(list[n]);
    vec2 middle = vec2(at) + 0.5;
    uint first = n * BORDER_POINTS;
    float depths[BORDER_POINTS];
    uint shown[BORDER_POINTS]; // a pixel around
    for (uint k = 0u; k < BORDER_POINTS; ++k) {
        BorderPoint seen = BorderPoint(UNSEEN, NOBODY);
        if (!ASKS_FIRST) seen = seen_points[first + k];
        depths[k] = seen.depth;
        shown[k] = seen.shown;
    }
    Start starts[AROUND];
    uint start_count = 0u;
    for (uint i = 0u; i < AROUND; ++i) {
        uint from = (i + OWN) % AROUND; // the own one first
        ivec2 beside = around(at, from);
        if (!is_in_picture(beside)) continue;
        uvec2 word = imageLoad(visibility, beside).xy;
        if (sees_nothing(word.x)) word = imageLoad(meshes_and_solids, beside).xy;
        if (!sees_mesh(word.x)) continue;
        bool known = false;
        for (uint j = 0u; j < start_count; ++j) known = known || starts[j].word == word;
        if (!known) starts[start_count++] = Start(word, from, vec3(0.0), 0u);
    }
    // what the triangles themselves cover
    for (uint i = 0u; i < start_count; ++i) {
        uvec2 word = starts[i].word;
        Facing f = facing_at(word.y, views[mesh_instances[seen_mesh_instance(word.x)].instance], middle);
        uint walks = 0u;
        for (uint k = 0u; k < BORDER_POINTS; ++k) {
            vec4 w = weights_of(f, point_of(k));
            bool nearer = w.w < depths[k]; // not where the triangle is seen edge-on
            bool within = min(w.x, min(w.y, w.z)) >= -WEIGHT_ROUNDING;
            if (nearer && !within) walks |= 1u << k;
            if (!nearer || !within || !is_shown(w.w, middle + point_of(k))) continue;
            depths[k] = w.w;
            shown[k] = starts[i].from;
        }
        starts[i].walks = walks;
    }
    // at a crease the triangles around cover all points: planes that pass close to what is known there lead nowhere,
    // which their depths tell sooner than a walk
    uint walking = 0u; // bits of points
    for (uint i = 0u; i < start_count; ++i) {
        uvec2 word = starts[i].word;
        Facing f = facing_at(word.y, views[mesh_instances[seen_mesh_instance(word.x)].instance], middle);
        for (uint left = starts[i].walks; left != 0u; left &= left - 1u) {
            uint k = uint(findLSB(left));
            if (weights_of(f, point_of(k)).w >= before(depths[k], LEADS_NOWHERE_PX)) starts[i].walks ^= 1u << k;
        }
        walking |= starts[i].walks;
    }
    for (uint i = 0u; i < start_count && walking != 0u; ++i) starts[i].n = unit_normal(starts[i].word.y);
    // and what they lead to
    for (uint i = 0u; i < start_count; ++i) {
        Start start = starts[i];
        View view = views[mesh_instances[seen_mesh_instance(start.word.x)].instance];
        for (uint walks = start.walks; walks != 0u; walks &= walks - 1u) {
            uint k = uint(findLSB(walks));
            vec2 pixel = middle + point_of(k);
            Met there = walk_to(start.word.y, view, pixel, before(depths[k], JUMP_PX));
            bool is = there.end == WALK_MET || there.end == WALK_TOO_FAR && start.from == OWN;
            if (!is || !(there.depth < depths[k]) || !is_shown(there.depth, pixel)) continue;
            depths[k] = there.depth;
            // no pixel around sees it, but one sees what lies most as it does
            vec3 normal = unit_normal(there.triangle);
            float likeness = -2.0;
            for (uint j = 0u; j < start_count; ++j) {
                float like = dot(normal, starts[j].n);
                if (starts[j].word.x != start.word.x || like <= likeness) continue;
                likeness = like;
                shown[k] = starts[j].from;
            }
        }
    }
    for (uint k = 0u; k < BORDER_POINTS; ++k) seen_points[first + k] = BorderPoint(depths[k], shown[k]);
}
