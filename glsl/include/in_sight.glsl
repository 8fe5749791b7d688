// Numbers the patch instances of the placed parts in sight without gaps. A patch instance out of sight has no thread
// and no place in lists. Needs the frame's constants, and IN_SIGHT_BINDING. Twin: src/twin/in_sight.rs.
//
//   instances   0 1 2 3 4 5 6 7 8 9 …    parts in sight: runs of consecutive patch instances
//   runs        └─┘     └───┘
//   place       0 1     2 3 4            PatchRun: first place, first patch instance
#ifndef IN_SIGHT_GLSL
#define IN_SIGHT_GLSL

layout(scalar, binding = IN_SIGHT_BINDING) readonly buffer InSight { PatchRun runs[]; };

// The patch instance at a place below frame.patch_instances_in_sight.
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
