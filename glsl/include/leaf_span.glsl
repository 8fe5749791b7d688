// The part of a ray inside of a leaf with equations. Needs solids.glsl, and the buffers `LeafSurface leaf_surfaces[]`,
// `samplerBuffer surfaces`, `samplerBuffer surface_places`.
//
//   planes: the later of what they begin, the earlier of what they end ──▶ other sides: spans, one after another
#ifndef LEAF_SPAN_GLSL
#define LEAF_SPAN_GLSL

// The part of the ray o + t d, seen from the eye; `side` becomes the leaf's last side that begins or ends at `at`.
Span leaf_span(Leaf leaf, vec3 o, vec3 d, float at, inout uint side) {
    uint k = leaf.first;
    uint end = leaf.first + leaf.count;
    float lo = -NEVER;
    float hi = NEVER;
    // most sides are planes: a loop of their own, for drivers that run both sides of every branch
    for (; k < end && lo < hi; ++k) {
        uint word = leaf_surfaces[k].surface;
        if (SOLIDS_HAVE != SURFACE_PLANE && (word & SIDE_PLANE) == 0u) break;
        Span one = plane_span(place_at(surface_places, word >> SIDE_SHIFT), (word & SIDE_NEGATIVE) != 0u, o, d);
        lo = max(lo, one.lo);
        hi = min(hi, one.hi);
        if (one.lo == at || one.hi == at) side = k;
    }
    Span s = Span(lo, hi, NEVER, NEVER);
    if (SOLIDS_HAVE != SURFACE_PLANE) {
        for (; k < end && s.lo < s.hi; ++k) {
            Span one = side_span(surfaces, surface_places, leaf_surfaces[k].surface, o, d);
            if (ends_at(one, at)) side = k;
            s = both(s, one);
        }
    }
    return s;
}

#endif
