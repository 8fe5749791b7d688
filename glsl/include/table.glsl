// Look-up in the u-intercept table: nearest scan line, then a binary search.
// Needs `frame`; whoever includes this defines TABLE_BINDING, where its five buffers begin.
#ifndef TABLE_GLSL
#define TABLE_GLSL

#include "along.glsl"
#include "bays.glsl"
#include "border_cells.glsl"
#include "words.glsl"

// as texels, which a driver fetches at once where it gathers words of storage buffers one by one
layout(binding = TABLE_BINDING + 0) uniform usamplerBuffer table_strips; // StripRows, at each strip's first bay
layout(binding = TABLE_BINDING + 1) uniform usamplerBuffer row_starts;
layout(binding = TABLE_BINDING + 2) uniform usamplerBuffer row_counts;   // flips << 1 | inside before the first
layout(binding = TABLE_BINDING + 3) uniform usamplerBuffer flips;        // u, in order in each row
layout(binding = TABLE_BINDING + 4) uniform usamplerBuffer border_cells; // one a band of a bay

// Whether a placed face whose bay items begin at `first` has rows at (u, v); `strips` as in Face.
bool table_covers(uint first, uint strips, vec2 uv) {
    float n = float(strip_count(strips));
    uint bays = bay_count(strips);
    StripRows rows = strip_rows(table_strips, first + uint(clamp(uv.y * n, 0.0, n - 1.0)) * bays);
    uint bay = bay_of(uv.x, bays);
    return rows.lines != 0u && bay >= rows.first_bay && bay <= last_bay(rows);
}

// A place in a row: between two flips.
struct Between {
    uint passed; // flips before it
    float before; // the last of them; far away without one
    float behind; // the next one
};

const float NO_FLIP = 3.0e38;

// Where u is among the flips [first, end); one at u is before it. A binary search among texels of four.
//
//     texel        mid - 1    │     mid      │    mid + 1
//     flips     ·  ·  f0  f1  │ f2 f3 f4 f5  │ f6  ·  ·  ·      all four passed: behind it; none: before it; else found
//
// Of two texels that u is between, both have been fetched.
Between between(uint first, uint end, float u) {
    uint lo = first / 4u;
    uint hi = (end + 3u) / 4u;
    Between place = Between(4u * lo, -NO_FLIP, NO_FLIP);
    while (lo < hi) {
        uint mid = (lo + hi) / 2u;
        uvec4 at = 4u * mid + uvec4(0u, 1u, 2u, 3u);
        vec4 flip = uintBitsToFloat(texelFetch(flips, int(mid)));
        // what lies before the row counts as passed, what lies behind it does not
        flip = mix(mix(flip, vec4(-NO_FLIP), lessThan(at, uvec4(first))), vec4(NO_FLIP), greaterThanEqual(at, uvec4(end)));
        bvec4 is_passed = lessThanEqual(flip, vec4(u));
        uvec4 ones = uvec4(is_passed);
        uint count = ones.x + ones.y + ones.z + ones.w;
        vec4 passed = mix(vec4(-NO_FLIP), flip, is_passed);
        vec4 left = mix(flip, vec4(NO_FLIP), is_passed);
        place.before = max(place.before, max(max(passed.x, passed.y), max(passed.z, passed.w)));
        place.behind = min(place.behind, min(min(left.x, left.y), min(left.z, left.w)));
        place.passed = 4u * mid + count;
        if (count == 4u) lo = mid + 1u;
        else if (count == 0u) hi = mid;
        else lo = hi;
    }
    place.passed = max(place.passed, first) - first;
    return place;
}

// Whether (u, v) is inside, and whether flips of its scan line are within `reach` of u, in its bay: along.glsl.
uint table_along(uint first, uint strips, vec2 uv, float reach) {
    float n = float(strip_count(strips));
    uint bays = bay_count(strips);
    float s = uv.y * n;
    if (!(s >= 0.0 && s < n)) return 0u;
    StripRows rows = strip_rows(table_strips, first + uint(s) * bays);
    if (rows.lines == 0u) return 0u;
    uint row = row_of(rows, min(uint(fract(s) * float(rows.lines)), rows.lines - 1u), bay_of(uv.x, bays));
    if (row >= frame.row_capacity) return ALONG_INSIDE; // the host grows the table and records again
    uint begin = word_at(row_starts, row);
    uint counted = word_at(row_counts, row);
    Between place = between(begin, begin + (counted >> 1), uv.x);
    uint along = (place.passed ^ counted) & 1u;
    if (place.before > uv.x - reach) along |= ALONG_BEFORE;
    if (place.behind < uv.x + reach) along |= ALONG_BEHIND;
    return along;
}

bool table_inside(uint first, uint strips, vec2 uv) {
    return (table_along(first, strips, uv, 0.0) & ALONG_INSIDE) != 0u;
}

// Whether all of a scan line from one u to another is in one bay.
bool table_one_bay(uint strips, float lo, float hi) {
    uint bays = bay_count(strips);
    return bay_of(lo, bays) == bay_of(hi, bays);
}

// Whether all of a box is inside or none of it: within a bay, what is looked up changes at trim curves alone.
bool table_same(uint first, uint strips, vec2 lo, vec2 hi) {
    float n = float(strip_count(strips));
    uint bays = bay_count(strips);
    float from = lo.y * n;
    float to = hi.y * n;
    if (!(from >= 0.0 && to < n)) return false;
    uint strip = uint(from);
    uint bay = bay_of(lo.x, bays);
    if (uint(to) != strip || bay_of(hi.x, bays) != bay) return false;
    uint low = uint(from * float(BORDER_BANDS));
    uint high = uint(to * float(BORDER_BANDS));
    if (high > low + 1u) return false;
    uint band = (first + strip * bays + bay) * BORDER_BANDS;
    uint up = strip * BORDER_BANDS;
    uvec4 marked = texelFetch(border_cells, int(band + low - up)) | texelFetch(border_cells, int(band + high - up));
    return (marked & columns_between(within_bay(lo.x, bay, bays), within_bay(hi.x, bay, bays))) == uvec4(0u);
}

#endif
