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
// one sub-patch more. Twin: src/twin/emit.rs.
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
layout(scalar, binding = 5) buffer Draws { Draw draws[]; }; // plain, then trimmed: draw_capacity each
layout(scalar, binding = 6) buffer CountersBuffer { Counters counters; };
#define RUNS_BINDING 7
#include "in_sight.glsl"

void main() {
    uint n = frame.listed_patch_instances;
    uint place = thread_number();
    if (place >= n) return;
    if (place == 0u) {
        counters.plain += sub_patch_starts[n];
        counters.trimmed += sub_patch_starts[2u * n] - sub_patch_starts[n];
        if (sub_patch_starts[2u * n] > frame.sub_patch_capacity) atomicOr(counters.failed, FAILED_SUB_PATCHES);
    }
    uint slot = place;
    uint group = 0u;
    if (sub_patch_starts[place + 1u] == sub_patch_starts[place]) {
        slot = n + place;
        group = 1u;
    }
    uint first = sub_patch_starts[slot];
    uint count = sub_patch_starts[slot + 1u] - first;
    if (count == 0u) return;
    uint patch_instance = patch_instance_at(place);
    uint vertices = (vertex_starts[slot + 1u] - vertex_starts[slot]) / count;
    uint before = vertex_starts[slot] - (group == 0u ? 0u : vertex_starts[n]);
    uint across = factors[patch_instance].splits & 0xffffu;
    for (uint k = 0u; k < count; ++k) {
        uint at = first + k;
        if (at >= frame.sub_patch_capacity) return;
        sub_patches[at] = SubPatch(patch_instance, (k % across) | (k / across) << 8);
        uint draw = (before + k * vertices) / frame.draw_vertices;
        if (group == 0u) atomicMax(counters.plain_draws, min(draw + 1u, frame.draw_capacity));
        else atomicMax(counters.trimmed_draws, min(draw + 1u, frame.draw_capacity));
        if (draw >= frame.draw_capacity) {
            atomicOr(counters.failed, FAILED_DRAWS);
            return;
        }
        draw += group * frame.draw_capacity;
        atomicAdd(draws[draw].vertex_count, 1u);
        atomicMin(draws[draw].first_vertex, at);
    }
}
