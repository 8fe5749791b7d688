// A strip of a face with many trim curves is cut into equal bins along u; a scan line then has a row in each of them.
//
//    v ▲  strip k   │ ●──● │    ● │ ●    │
//      │            └──────┴──────┴──────┘      a crossing belongs to the bin of its u; one before the first visible
//      │   windings   0      0      1           bin belongs to that bin, one behind the last to none
//      └──────────────▶ u
//
// A look-up gives the same result as without bins: a row starts with the winding number of the rows before it. Twin of
// src/twin/u_bins.rs.
#ifndef BINS_GLSL
#define BINS_GLSL

// `strips` is Face.strips.
uint strip_count(uint strips) { return strips & 0xffffu; }
uint bin_count(uint strips) { return strips >> 16; }

// Monotone in u; u beyond the face belongs to its outermost bins.
uint bin_of(float u, uint bins) {
    precise float at = u * float(bins);
    return at >= 1.0 ? uint(min(at, float(bins - 1u))) : 0u;
}

// u relative to a bin, 0 to 1 within it.
float within_bin(float u, uint bin, uint bins) {
    precise float at = u * float(bins) - float(bin);
    return at;
}

// The first visible bin, and the number from there to the last; `seen` has a bit for each visible bin.
uvec2 seen_range(uint seen) {
    if (seen == 0u) return uvec2(0u, 1u);
    uint first = uint(findLSB(seen));
    return uvec2(first, uint(findMSB(seen)) - first + 1u);
}

// The rows of a strip: the first one, the number of scan lines, the first visible bin, and the number of bins from
// there.
struct StripRows {
    uint first;
    uint lines;
    uint first_bin;
    uint bins;
};

StripRows strip_rows(usamplerBuffer strips, uint bin_instance) {
    uvec4 words = texelFetch(strips, int(bin_instance));
    return StripRows(words.x, words.y, words.z, words.w);
}

uint last_bin(StripRows rows) { return rows.first_bin + rows.bins - 1u; }

// The row of a scan line in a bin; if it has none there, in the nearest bin that has one.
uint row_of(StripRows rows, uint line, uint bin) {
    return rows.first + (clamp(bin, rows.first_bin, last_bin(rows)) - rows.first_bin) * rows.lines + line;
}

#endif
