// Look-up in the u-intercept table: nearest scan line, then a binary search.
// Needs `frame`; whoever includes this defines TABLE_BINDING, where its four buffers begin.
#ifndef TABLE_GLSL
#define TABLE_GLSL

#include "border_cells.glsl"
#include "words.glsl"

// as texels, which a driver fetches at once where it gathers words of storage buffers one by one
layout(binding = TABLE_BINDING + 0) uniform usamplerBuffer table_strips; // first row, rows
layout(binding = TABLE_BINDING + 1) uniform usamplerBuffer row_starts;
layout(binding = TABLE_BINDING + 2) uniform usamplerBuffer row_counts;
layout(binding = TABLE_BINDING + 3) uniform usamplerBuffer flips;        // u, in order in each row
layout(binding = TABLE_BINDING + 4) uniform usamplerBuffer border_cells; // one a band

uint rows_of_strip(uint strip) { return texelFetch(table_strips, int(strip)).y; }

// How many of the flips [first, end) are at u or before it: a binary search among texels of four.
//
//     texel        mid - 1    │     mid      │    mid + 1
//     flips     ·  ·  f0  f1  │ f2 f3 f4 f5  │ f6  ·  ·  ·      all four passed: behind it; none: before it; else found
uint flips_passed(uint first, uint end, float u) {
    uint lo = first / 4u;
    uint hi = (end + 3u) / 4u;
    uint passed = 4u * lo;
    while (lo < hi) {
        uint mid = (lo + hi) / 2u;
        uvec4 at = 4u * mid + uvec4(0u, 1u, 2u, 3u);
        vec4 flip = uintBitsToFloat(texelFetch(flips, int(mid)));
        // what lies before the row counts as passed, what lies behind it does not
        uvec4 is_passed = uvec4(lessThan(at, uvec4(first))) | uvec4(lessThan(at, uvec4(end))) & uvec4(lessThanEqual(flip, vec4(u)));
        uint count = is_passed.x + is_passed.y + is_passed.z + is_passed.w;
        passed = 4u * mid + count;
        if (count == 4u) lo = mid + 1u;
        else if (count == 0u) hi = mid;
        else lo = hi;
    }
    return max(passed, first) - first;
}

bool table_inside(uint first_strip, float strips, vec2 uv) {
    float s = uv.y * strips;
    if (!(s >= 0.0 && s < strips)) return false;
    uvec2 strip = texelFetch(table_strips, int(first_strip + uint(s))).xy;
    if (strip.y == 0u) return false;
    uint row = strip.x + min(uint(fract(s) * float(strip.y)), strip.y - 1u);
    if (row >= frame.row_capacity) return true; // the host grows the table and records again
    uint first = word_at(row_starts, row);
    return (flips_passed(first, first + word_at(row_counts, row), uv.x) & 1u) != 0u;
}

// Whether all of a box is inside or none of it: within a strip, what is looked up changes at trim curves alone.
bool table_same(uint first_strip, float strips, vec2 lo, vec2 hi) {
    float from = lo.y * strips;
    float to = hi.y * strips;
    if (!(from >= 0.0 && to < strips)) return false;
    uint first = uint(from * float(BORDER_BANDS));
    uint last = uint(to * float(BORDER_BANDS));
    if (last > first + 1u || first / BORDER_BANDS != last / BORDER_BANDS) return false;
    int band = int(first_strip * BORDER_BANDS);
    uvec4 marked = texelFetch(border_cells, band + int(first)) | texelFetch(border_cells, band + int(last));
    return (marked & columns_between(lo.x, hi.x)) == uvec4(0u);
}

#endif
