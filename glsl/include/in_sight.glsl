// Numbers the items of the placed parts in sight without gaps. An item out of sight has no thread and no place in
// lists. Needs the frame's constants, and IN_SIGHT_BINDING. Twin: src/twin/in_sight.rs.
//
//   items   0 1 2 3 4 5 6 7 8 9 …        parts in sight: runs of consecutive items
//   runs        └─┘     └───┘
//   place       0 1     2 3 4            ItemRun: first place, first item
#ifndef IN_SIGHT_GLSL
#define IN_SIGHT_GLSL

layout(scalar, binding = IN_SIGHT_BINDING) readonly buffer InSight { ItemRun runs[]; };

// The item at a place below frame.items_in_sight.
uint item_at(uint place) {
    uint lo = 0u;
    uint hi = frame.run_count;
    while (hi - lo > 1u) {
        uint mid = (lo + hi) / 2u;
        if (runs[mid].place <= place) lo = mid;
        else hi = mid;
    }
    return runs[lo].item + place - runs[lo].place;
}

#endif
