// Look-up in the u-intercept table: nearest scan line, then a binary search. Needs `frame`; the includer defines
// TABLE_BINDING, the first of its four buffers.
#ifndef TABLE_GLSL
#define TABLE_GLSL

#include "along.glsl"
#include "u_bins.glsl"
#include "border_cells.glsl"

// as texels: a driver fetches them at once, but gathers words of storage buffers one by one
layout(binding = TABLE_BINDING + 0) uniform usamplerBuffer table_strips; // StripRows, at each strip's first bin
layout(binding = TABLE_BINDING + 1) uniform usamplerBuffer table_rows;   // first flip; flips << 1 | inside before it
layout(binding = TABLE_BINDING + 2) uniform usamplerBuffer flips;        // u, in order in each row, two a texel
layout(binding = TABLE_BINDING + 3) uniform usamplerBuffer border_cells; // one a band of a bin

// Whether a placed face whose bin instances begin at `first` has rows at (u, v); `strips` as in Face.
bool table_covers(uint first, uint strips, vec2 uv) {
    float n = float(strip_count(strips));
    uint bins = bin_count(strips);
    StripRows rows = strip_rows(table_strips, first + uint(clamp(uv.y * n, 0.0, n - 1.0)) * bins);
    uint bin = bin_of(uv.x, bins);
    return rows.lines != 0u && bin >= rows.first_bin && bin <= last_bin(rows);
}

const float NO_FLIP = 3.0e38;

// A point's place among the flips of its row; a flip at its u is before it. A binary search among texels of two flips.
//
//     texel     mid - 1  │   mid   │ mid + 1
//     flips      ·  f0   │  f1 f2  │ f3  ·         both passed: behind it; none: before it; else found
//
// Of the two texels around u, both have been fetched.
struct Search {
    float u;
    uint first; // of the row's flips
    uint end;
    uint inside; // before the first flip
    uint lo; // range of texels that may contain it
    uint hi;
    uint passed; // flips before it, including those of earlier rows
    float before; // the last flip of the row; far away without one
    float behind; // the next flip
};

// The start of the search for (u, v). In a row without flips it is also the end.
Search search_at(uint first, uint strips, vec2 uv) {
    float n = float(strip_count(strips));
    uint bins = bin_count(strips);
    float s = uv.y * n;
    bool on_face = s >= 0.0 && s < n;
    StripRows rows = strip_rows(table_strips, first + (on_face ? uint(s) * bins : 0u));
    uint row = row_of(rows, min(uint(fract(s) * float(rows.lines)), rows.lines - 1u), bin_of(uv.x, bins));
    bool has_row = on_face && rows.lines != 0u;
    bool has_room = row < frame.row_capacity;
    row = has_row && has_room ? row : 0u;
    uvec2 told = texelFetch(table_rows, int(row)).xy;
    if (!has_row) told.y = 0u;
    else if (!has_room) told.y = 1u; // the host enlarges the table and records again
    uint end = told.x + (told.y >> 1);
    uint lo = told.x / 2u;
    uint hi = end > told.x ? (end + 1u) / 2u : lo;
    return Search(uv.x, told.x, end, told.y & 1u, lo, hi, told.x, -NO_FLIP, NO_FLIP);
}

bool is_open(Search s) { return s.lo < s.hi; }

// One step; none after the end.
void halve(inout Search s) {
    uint mid = (s.lo + s.hi) / 2u;
    uvec2 at = 2u * mid + uvec2(0u, 1u);
    vec2 flip = uintBitsToFloat(texelFetch(flips, int(mid)).xy);
    // flips of earlier rows count as passed, those of later rows do not
    flip = mix(mix(flip, vec2(-NO_FLIP), lessThan(at, uvec2(s.first))), vec2(NO_FLIP), greaterThanEqual(at, uvec2(s.end)));
    bvec2 is_passed = lessThanEqual(flip, vec2(s.u));
    uint count = uint(is_passed.x) + uint(is_passed.y);
    vec2 passed = mix(vec2(-NO_FLIP), flip, is_passed);
    vec2 left = mix(flip, vec2(NO_FLIP), is_passed);
    if (is_open(s)) {
        s.before = max(s.before, max(passed.x, passed.y));
        s.behind = min(s.behind, min(left.x, left.y));
        s.passed = 2u * mid + count;
        uint hi = count == 0u ? mid : s.hi;
        s.lo = count == 2u ? mid + 1u : count == 0u ? s.lo : s.hi;
        s.hi = hi;
    }
}

// Whether the point is inside, and whether flips of its scan line are within `reach` of u, in its bin: along.glsl.
uint told_by(Search s, float reach) {
    uint along = (max(s.passed, s.first) - s.first ^ s.inside) & 1u;
    if (s.before > s.u - reach) along |= ALONG_BEFORE;
    if (s.behind < s.u + reach) along |= ALONG_BEHIND;
    return along;
}

uint table_along(uint first, uint strips, vec2 uv, float reach) {
    Search s = search_at(first, strips, uv);
    while (is_open(s)) halve(s);
    return told_by(s, reach);
}

bool table_inside(uint first, uint strips, vec2 uv) {
    return (table_along(first, strips, uv, 0.0) & ALONG_INSIDE) != 0u;
}

// Whether the scan line from `lo` to `hi` in u lies in one bin.
bool table_one_bin(uint strips, float lo, float hi) {
    uint bins = bin_count(strips);
    return bin_of(lo, bins) == bin_of(hi, bins);
}

// Whether a box is inside or outside as a whole: within a bin, the look-up changes only at trim curves.
bool table_same(uint first, uint strips, vec2 lo, vec2 hi) {
    float n = float(strip_count(strips));
    uint bins = bin_count(strips);
    float from = lo.y * n;
    float to = hi.y * n;
    if (!(from >= 0.0 && to < n)) return false;
    uint strip = uint(from);
    uint bin = bin_of(lo.x, bins);
    if (uint(to) != strip || bin_of(hi.x, bins) != bin) return false;
    uint low = uint(from * float(BORDER_BANDS));
    uint high = uint(to * float(BORDER_BANDS));
    if (high > low + 1u) return false;
    uint band = (first + strip * bins + bin) * BORDER_BANDS;
    uint up = strip * BORDER_BANDS;
    uvec4 marked = texelFetch(border_cells, int(band + low - up)) | texelFetch(border_cells, int(band + high - up));
    return (marked & columns_between(within_bin(lo.x, bin, bins), within_bin(hi.x, bin, bins))) == uvec4(0u);
}

#endif
