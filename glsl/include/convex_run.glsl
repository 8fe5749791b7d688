// Leaves of a tile one behind the other, all of which must hold a point, as half-spaces of a convex solid must: each
// leads to the next one where the point is inside, and all to one place where it is not.
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

// Exits that lead to leaves ahead of the scan, but for those from a leaf to the one behind it.
struct Jumps {
    uint nearest;
    uint farthest;
    uint unknown; // up to this leaf, any may be led to: only the nearest is known
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
