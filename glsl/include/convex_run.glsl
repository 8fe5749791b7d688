// A run: consecutive leaves of a tile that all have to contain a point, as the half-spaces of a convex solid do. Inside a
// leaf, the walk goes to the next leaf. Outside, every leaf of the run leads to the same place.
//
//      leaf 1  ├─────────────────────▶          only where all of them together begin and end does the item change
//      leaf 2       ├────────────────▶
//      leaf 3  ◀──────────────┤
//                   lo        hi
//
// Needs solids.glsl and the constant NOBODY.
#ifndef CONVEX_RUN_GLSL
#define CONVEX_RUN_GLSL

struct Run {
    float lo;
    float hi;
    uint next; // the leaf that it leads to, or NOBODY
    uint out_exit;
};

const Run NO_RUN = Run(NEVER, -NEVER, NOBODY, NOBODY);

float next_of_run(Run run, float t) {
    if (!(run.lo < run.hi)) return NEVER;
    return t < run.lo ? run.lo : t < run.hi ? run.hi : NEVER;
}

// Where exits of the leaves so far lead, ahead of the scan. A leaf that such an exit leads to begins a new run. An exit to
// the very next leaf does not count.
struct Jumps {
    uint nearest;
    uint farthest;
    uint unknown; // only the nearest is known: up to this leaf, an exit may lead to any
};

bool is_led_to(inout Jumps jumps, uint i) {
    if (i == jumps.nearest) {
        jumps.unknown = jumps.farthest;
        jumps.nearest = NOBODY;
    }
    return i <= jumps.unknown;
}

void add_jump(inout Jumps jumps, uint to) {
    if (to >= EXIT_FALSE) return;
    jumps.nearest = min(jumps.nearest, to);
    jumps.farthest = max(jumps.farthest, to);
}

#endif
