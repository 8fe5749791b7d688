// The state of a Boolean solid's leaf at a depth of the pixel's ray. Needs solids.glsl, boundary_operands.glsl and the
// buffer `usamplerBuffer fragments`.
#ifndef CROSSING_GLSL
#define CROSSING_GLSL

// The state of a leaf at depth t, for a scan.
struct Crossing {
    bool inside;   // just behind t
    bool before;   // just in front of it
    bool ends;     // the leaf begins or ends there
    float next;    // the next depth where it does
};

Crossing crossing_of(Span s, float t) {
    return Crossing(inside_span(s, t), inside_before(s, t), ends_at(s, t), next_of_span(s, t));
}

// For a boundary operand; `last` is its last fragment at t.
Crossing crossing_of(uint operand, float t, uint first, uint count, out uint last) {
    Crossing c = Crossing(false, false, false, NEVER);
    last = 0u;
    bool begun = false;
    for (uint i = first; i < first + count; ++i) {
        Fragment f = fragment_at(fragments, i);
        if ((f.operand & FRAGMENT_OPERAND) != operand) continue;
        bool leaves_ = (f.operand & FRAGMENT_LEAVES) != 0u;
        bool passed = f.depth <= t;
        if (f.depth > t) c.next = min(c.next, f.depth);
        // entries and exits alternate: the first fragment behind t decides, or the last before it
        if (passed) c.inside = !leaves_;
        if (f.depth < t) c.before = !leaves_;
        if (!begun) {
            begun = true;
            if (!passed) c.inside = leaves_;
            if (!(f.depth < t)) c.before = leaves_;
        }
        if (f.depth == t) {
            c.ends = true;
            last = i;
        }
    }
    return c;
}

#endif
