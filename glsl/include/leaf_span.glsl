// The part of a ray inside a leaf with equations. Needs solids.glsl, `usamplerBuffer leaf_surfaces`,
// `samplerBuffer surfaces`, `samplerBuffer surface_places`.
//
//   sides other than planes: spans, one after another ──▶ planes: the latest of their entries, the earliest of their
//                                                                   exits
#ifndef LEAF_SPAN_GLSL
#define LEAF_SPAN_GLSL

// The part of the ray o + t d, relative to the eye; `own` is TileLeaf.of. `side` becomes the last of the leaf's sides
// at which it begins or ends at `at`.
Span leaf_span(uint own, vec3 o, vec3 d, float at, inout uint side) {
    uint k = own >> LEAF_FLAG_BITS;
    Span s = EVERYTHING;
    // loops test at their end, for drivers that count the rounds of a loop and end it
    if (SOLIDS_HAVE != SURFACE_PLANE && (own & LEAF_ROUNDS) != 0u) {
        bool more;
        do {
            uint word = side_word(leaf_surfaces, k);
            Span one = side_span(surfaces, surface_places, word, o, d);
            if (ends_at(one, at)) side = k;
            s = both(s, one);
            more = (word & SIDE_MORE) != 0u && s.lo < s.hi;
            ++k;
        } while (more);
    }
    // most sides are planes: they have a loop of their own, for drivers that run both sides of every branch
    if ((own & LEAF_PLANES) != 0u && s.lo < s.hi) {
        float lo = -NEVER;
        float hi = NEVER;
        bool more;
        do {
            uint word = side_word(leaf_surfaces, k);
            Span one = plane_span(place_at(surface_places, word >> SIDE_SHIFT), (word & SIDE_NEGATIVE) != 0u, o, d);
            lo = max(lo, one.lo);
            hi = min(hi, one.hi);
            if (one.lo == at || one.hi == at) side = k;
            more = (word & SIDE_MORE) != 0u && lo < hi;
            ++k;
        } while (more);
        s = both(s, Span(lo, hi, NEVER, NEVER));
    }
    return s;
}

#endif
