// Look-up in the u-intercept table: nearest scan line, then a binary search.
// Needs `frame`; whoever includes this defines TABLE_BINDING, where its four buffers begin.
#ifndef TABLE_GLSL
#define TABLE_GLSL

// texels, which a driver fetches at once where it gathers words of storage buffers one by one
layout(binding = TABLE_BINDING + 0) uniform usamplerBuffer line_starts;
layout(binding = TABLE_BINDING + 1) uniform usamplerBuffer row_starts;
layout(binding = TABLE_BINDING + 2) uniform usamplerBuffer row_counts;
layout(binding = TABLE_BINDING + 3) uniform samplerBuffer flips;

// First row of a strip; of the one behind the last, where it ends.
uint first_row(uint strip) { return texelFetch(line_starts, int(strip)).x; }

bool table_inside(uint first_strip, float strips, vec2 uv) {
    float s = uv.y * strips;
    if (!(s >= 0.0 && s < strips)) return false;
    uint strip = first_strip + uint(s);
    uint base = first_row(strip);
    uint count = first_row(strip + 1u) - base;
    if (count == 0u) return false;
    uint row = base + min(uint(fract(s) * float(count)), count - 1u);
    if (row >= frame.row_capacity) return true; // the host grows the table and records again
    uint lo = texelFetch(row_starts, int(row)).x;
    uint first = lo;
    uint hi = lo + texelFetch(row_counts, int(row)).x;
    while (lo < hi) {
        uint mid = (lo + hi) / 2u;
        if (texelFetch(flips, int(mid)).x <= uv.x) lo = mid + 1u;
        else hi = mid;
    }
    return ((lo - first) & 1u) != 0u;
}

#endif
