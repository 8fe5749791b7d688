// Look-up in the u-intercept table: nearest scan line, then a binary search.
// Needs `frame` and buffers `uint line_starts[]`, `uint row_starts[]`, `uint row_counts[]`, `float flips[]`.
#ifndef TABLE_GLSL
#define TABLE_GLSL

bool table_inside(uint first_strip, float strips, vec2 uv) {
    float s = uv.y * strips;
    if (!(s >= 0.0 && s < strips)) return false;
    uint strip = first_strip + uint(s);
    uint base = line_starts[strip];
    uint count = line_starts[strip + 1u] - base;
    if (count == 0u) return false;
    uint row = base + min(uint(fract(s) * float(count)), count - 1u);
    if (row >= frame.row_capacity) return true; // the host grows the table and records again
    uint lo = row_starts[row];
    uint first = lo;
    uint hi = lo + row_counts[row];
    while (lo < hi) {
        uint mid = (lo + hi) / 2u;
        if (flips[mid] <= uv.x) lo = mid + 1u;
        else hi = mid;
    }
    return ((lo - first) & 1u) != 0u;
}

#endif
