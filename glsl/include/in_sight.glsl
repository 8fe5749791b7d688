// Numbers the listed patch instances without gaps: those of the faces in sight, or of a list of parts (parts.glsl).
// Others have no thread and no place in lists. Needs the frame's constants, and RUNS_BINDING. Twin:
// src/twin/in_sight.rs.
//
//   instances   0 1 2 3 4 5 6 7 8 9 …    listed parts: runs of consecutive patch instances
//   runs        └─┘     └───┘
//   place       0 1     2 3 4            PatchRun: first place, first patch instance
#ifndef IN_SIGHT_GLSL
#define IN_SIGHT_GLSL

layout(scalar, binding = RUNS_BINDING) readonly buffer Runs { PatchRun runs[]; };

// The patch instance at a place below frame.listed_patch_instances.
uint patch_instance_at(uint place) {
    uint lo = 0u;
    uint hi = frame.run_count;
    while (hi - lo > 1u) {
        uint mid = (lo + hi) / 2u;
        if (runs[mid].place <= place) lo = mid;
        else hi = mid;
    }
    return runs[lo].patch_instance + place - runs[lo].place;
}

#endif
