#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `part_runs`: the runs of the patch instances of listed parts, and the dispatches over them. One thread for each
// part in sight; the first of all also writes the frame's constants. Twin: src/twin/parts.rs.
#include "scene.glsl"
#include "parts.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, push_constant) uniform Push { PartList push; };
layout(scalar, binding = 0) buffer Frames { Frame frame; };
#include "grid.glsl"
layout(scalar, binding = 1) readonly buffer PartsInSight { PartInSight parts[]; };
layout(scalar, binding = 2) readonly buffer PartCounts { uint part_counts[]; };
layout(scalar, binding = 3) readonly buffer PartStarts { uint part_starts[]; }; // their prefix sums, and the total
layout(scalar, binding = 4) writeonly buffer Runs { PatchRun runs[]; };
layout(scalar, binding = 5) writeonly buffer Dispatches { ListDispatches dispatches; };
layout(scalar, binding = 6) buffer CountersBuffer { Counters counters; };

const uint THREADS = 64u;      // of a workgroup in passes over patch instances
const uint SCAN_BLOCK = 1024u; // elements of a workgroup in the prefix sum

void main() {
    uint n = thread_number();
    uint patch_instances = part_starts[push.parts];
    if (n == 0u) {
        frame.listed_patch_instances = patch_instances;
        frame.run_count = part_starts[2u * push.parts] - patch_instances;
        dispatches.threads = grid_of((patch_instances + THREADS - 1u) / THREADS);
        uint scanned = (2u + frame.corner_lists) * patch_instances + 1u;
        dispatches.blocks = grid_of((scanned + SCAN_BLOCK - 1u) / SCAN_BLOCK);
        dispatches.scanned = scanned;
        if (push.list != LIST_ALL) counters.listed_patches += patch_instances;
    }
    if (n >= push.parts) return;
    if (part_counts[push.parts + n] == 0u) return;
    runs[part_starts[push.parts + n] - patch_instances] = PatchRun(part_starts[n], parts[n].first_patch_instance);
}
