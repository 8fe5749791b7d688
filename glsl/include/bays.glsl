// A strip of a face with many trim curves is cut into equal bays along u; a scan line then has a row in each of them.
//
//    v ▲  strip k   │ ●──● │    ● │ ●    │
//      │            └──────┴──────┴──────┘      a crossing belongs to the bay of its u, one before the first bay that is
//      │   windings   0      0      1           seen to that bay, one behind the last to none: nobody asks there
//      └──────────────▶ u
//
// What is looked up is the same as without bays: a row starts with the winding number that those before it add up to.
// Twin of src/twin/bays.rs.
#ifndef BAYS_GLSL
#define BAYS_GLSL

// Of a face: Face.strips.
uint strip_count(uint strips) { return strips & 0xffffu; }
uint bay_count(uint strips) { return strips >> 16; }

// Never less for a larger u; what is beyond the face belongs to its outermost bays.
uint bay_of(float u, uint bays) {
    precise float at = u * float(bays);
    return at >= 1.0 ? uint(min(at, float(bays - 1u))) : 0u;
}

// u as it is in a bay, 0 to 1 within it.
float within_bay(float u, uint bay, uint bays) {
    precise float at = u * float(bays) - float(bay);
    return at;
}

// The first bay that is seen, and how many from there to the last; `seen` has a bit for each that is.
uvec2 seen_range(uint seen) {
    if (seen == 0u) return uvec2(0u, 1u);
    uint first = uint(findLSB(seen));
    return uvec2(first, uint(findMSB(seen)) - first + 1u);
}

// Where a strip's rows are: the first one, scan lines, the first bay that is seen, and how many from there on.
struct StripRows {
    uint first;
    uint lines;
    uint first_bay;
    uint bays;
};

StripRows strip_rows(usamplerBuffer strips, uint item) {
    uvec4 words = texelFetch(strips, int(item));
    return StripRows(words.x, words.y, words.z, words.w);
}

uint last_bay(StripRows rows) { return rows.first_bay + rows.bays - 1u; }

// The row of a scan line in a bay; in the nearest one where it has none in that.
uint row_of(StripRows rows, uint line, uint bay) {
    return rows.first + (clamp(bay, rows.first_bay, last_bay(rows)) - rows.first_bay) * rows.lines + line;
}

#endif
