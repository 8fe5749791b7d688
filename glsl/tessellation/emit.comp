#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `emit`: writes the list of sub-patches, and the draws that cover it. One thread for each patch instance in
// sight.
//
//   vertices before a patch instance  0 ..... draw_vertices ..... 2 draw_vertices ....
//   draw that covers it      |   0   |        1         |        2
//
// A draw starts with the first sub-patch of its interval, so none holds more than draw_vertices and
// one sub-patch more. If one draw covers a list, one thread writes it: millions of atomics on one word take longer than
// all else. In the lists of patches that are drawn by their corners, a vertex of a draw is a corner; in the others it is
// a sub-patch. Twin: src/twin/emit.rs.
#include "scene.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer FactorsBuffer { Factors factors[]; };
layout(scalar, binding = 2) readonly buffer SubPatchStarts { uint sub_patch_starts[]; };
layout(scalar, binding = 3) readonly buffer VertexStarts { uint vertex_starts[]; };
layout(scalar, binding = 4) writeonly buffer SubPatches { SubPatch sub_patches[]; };
struct Draw {
    uint vertex_count;
    uint instance_count;
    uint first_vertex;
    uint first_instance;
};
layout(scalar, binding = 5) buffer Draws { Draw draws[]; }; // draw_capacity for each list
layout(scalar, binding = 6) buffer CountersBuffer { Counters counters; };
#define RUNS_BINDING 7
#include "in_sight.glsl"

// Vertices of a list.
uint vertices_of(uint list) {
    uint n = frame.listed_patch_instances;
    return vertex_starts[(list + 1u) * n] - vertex_starts[list * n];
}

// Vertices of a draw for each of its sub-patches.
uint vertices_of_one(uint list) { return list >= CORNER_LIST ? CORNER_VERTICES : 1u; }

// `used` draws of the list are not empty, or more.
void use_draws(uint list, uint used) {
    if (list == PLAIN_LIST) atomicMax(counters.plain_draws, used);
    else if (list == TRIMMED_LIST) atomicMax(counters.trimmed_draws, used);
    else if (list == CORNER_LIST) atomicMax(counters.corner_draws, used);
    else atomicMax(counters.trimmed_corner_draws, used);
}

// The first thread alone: the counters, and the draws of lists that one draw covers.
void count_all() {
    uint n = frame.listed_patch_instances;
    uint lists = 2u + frame.corner_lists;
    uint total = sub_patch_starts[lists * n];
    uint trimmed_by_corners = frame.corner_lists > 1u ? total - sub_patch_starts[3u * n] : 0u;
    uint trimmed = sub_patch_starts[2u * n] - sub_patch_starts[n] + trimmed_by_corners;
    counters.plain += total - trimmed;
    counters.trimmed += trimmed;
    counters.corners += total - sub_patch_starts[2u * n];
    if (total > frame.sub_patch_capacity) atomicOr(counters.failed, FAILED_SUB_PATCHES);
    for (uint list = 0u; list < lists; ++list) {
        uint first = min(sub_patch_starts[list * n], frame.sub_patch_capacity);
        uint end = min(sub_patch_starts[(list + 1u) * n], frame.sub_patch_capacity);
        if (first == end || vertices_of(list) > frame.draw_vertices) continue;
        uint of_one = vertices_of_one(list);
        draws[list * frame.draw_capacity] = Draw((end - first) * of_one, 1u, first * of_one, 0u);
        use_draws(list, 1u);
    }
}

void main() {
    uint n = frame.listed_patch_instances;
    uint place = thread_number();
    if (place >= n) return;
    if (place == 0u) count_all();
    uint list = 0u;
    uint slot = place;
    while (list < 1u + frame.corner_lists && sub_patch_starts[slot + 1u] == sub_patch_starts[slot]) {
        ++list;
        slot += n;
    }
    uint first = sub_patch_starts[slot];
    uint count = sub_patch_starts[slot + 1u] - first;
    if (count == 0u) return;
    uint patch_instance = patch_instance_at(place);
    uint vertices = (vertex_starts[slot + 1u] - vertex_starts[slot]) / count;
    uint before = vertex_starts[slot] - vertex_starts[list * n];
    uint across = factors[patch_instance].splits & 0xffffu;
    uint of_one = vertices_of_one(list);
    bool alone = vertices_of(list) <= frame.draw_vertices; // `count_all` writes the draw
    for (uint k = 0u; k < count; ++k) {
        uint at = first + k;
        if (at >= frame.sub_patch_capacity) return;
        sub_patches[at] = SubPatch(patch_instance, (k % across) | (k / across) << 8);
        if (alone) continue;
        uint draw = (before + k * vertices) / frame.draw_vertices;
        use_draws(list, min(draw + 1u, frame.draw_capacity));
        if (draw >= frame.draw_capacity) {
            atomicOr(counters.failed, FAILED_DRAWS);
            return;
        }
        draw += list * frame.draw_capacity;
        atomicAdd(draws[draw].vertex_count, of_one);
        atomicMin(draws[draw].first_vertex, at * of_one);
    }
}
