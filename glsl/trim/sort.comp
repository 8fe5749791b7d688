#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `sort`: sorts each row by u, and reduces it to the places where inside and outside change. One thread a row.
// Sorting makes the result independent of the order of insertion. Few intercepts, as most rows have, are sorted in
// registers, others in place by heap sort. Words behind a row's flips are unused. A driver may end the loops of a row
// of more than some 4500, which counts as a clamp.
//
//   intercepts   ↑  ↑  ↓  ↑  ↓  ↓        winding   0 1 2 1 2 1 0
//   flips        |              |        inside    0 1 1 1 1 1 0
//
// Twin: src/twin/sort.rs.
#include "ordered.glsl"
#include "scene.glsl"
#include "words.glsl"

// Strips of some face have several bins: their rows start with the winding number of the bins to the left.
layout(constant_id = 1) const bool SCENE_HAS_BINS = false;

layout(local_size_x = 128) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1) uniform usamplerBuffer row_starts;
layout(scalar, binding = 2) readonly buffer RowTotal { uint row_total; };
layout(scalar, binding = 3) writeonly buffer Rows { uvec2 rows[]; }; // first flip; flips << 1 | inside before it
layout(scalar, binding = 4) buffer Intercepts { uint intercepts[]; };
layout(scalar, binding = 5) buffer CountersBuffer { Counters counters; };
layout(scalar, binding = 6) readonly buffer RowWindings { int row_windings[]; }; // with SCENE_HAS_BINS

const uint FEW = 16u;

void sift(uint first, uint root, uint count) {
    uint value = intercepts[first + root];
    while (true) {
        uint child = 2u * root + 1u;
        if (child >= count) break;
        if (child + 1u < count && intercepts[first + child + 1u] > intercepts[first + child]) ++child;
        if (intercepts[first + child] <= value) break;
        intercepts[first + root] = intercepts[first + child];
        root = child;
    }
    intercepts[first + root] = value;
}

// Inserts each number among those before it, all in registers; returns the number of flips. Loops are as long as the
// row: a software rasteriser runs as many rounds as the longest of the rows that it processes together.
uint sort_few(uint first, uint count, int winding) {
    uint v[FEW];
    for (uint k = 0u; k < FEW; ++k) v[k] = 0xffffffffu;
    for (uint i = 0u; i < count; ++i) {
        uint moved = intercepts[first + i];
        for (uint k = 0u; k < FEW; ++k) {
            uint least = min(v[k], moved);
            moved = max(v[k], moved);
            v[k] = least;
        }
    }
    uint flips = 0u;
    for (uint i = 0u; i < count; ++i) {
        uint bits = v[0];
        for (uint k = 1u; k < FEW; ++k) v[k - 1u] = v[k];
        int next = winding + ((bits & 1u) != 0u ? 1 : -1);
        if ((winding == 0) != (next == 0)) {
            intercepts[first + flips] = floatBitsToUint(from_ordered(bits & ~1u));
            ++flips;
        }
        winding = next;
    }
    return flips;
}

void main() {
    uint row = thread_number();
    uint row_count = counters.rows;
    if (row >= row_count) return;
    if (row == 0u) {
        counters.intercepts = row_total;
        if (row_total > frame.intercept_capacity) atomicOr(counters.failed, FAILED_INTERCEPTS);
    }
    uint first = word_at(row_starts, row);
    uint end = row + 1u < row_count ? word_at(row_starts, row + 1u) : row_total;
    if (end > frame.intercept_capacity) {
        rows[row] = uvec2(first, 0u); // the host enlarges the table and records again
        return;
    }
    uint count = end - first;
    int winding = SCENE_HAS_BINS ? row_windings[row] : 0;
    uint inside = winding != 0 ? 1u : 0u;
    if (count <= FEW) {
        rows[row] = uvec2(first, sort_few(first, count, winding) << 1 | inside);
        return;
    }
    for (uint i = count / 2u; i > 0u; --i) sift(first, i - 1u, count);
    for (uint i = count; i > 1u; --i) {
        uint top = intercepts[first];
        intercepts[first] = intercepts[first + i - 1u];
        intercepts[first + i - 1u] = top;
        sift(first, 0u, i - 1u);
    }
    uint flips = 0u;
    uint steps = 0u;
    for (uint i = 0u; i < count; ++i) {
        ++steps;
        uint bits = intercepts[first + i];
        int next = winding + ((bits & 1u) != 0u ? 1 : -1);
        if ((winding == 0) != (next == 0)) {
            intercepts[first + flips] = floatBitsToUint(from_ordered(bits & ~1u));
            ++flips;
        }
        winding = next;
    }
    if (steps != count) atomicAdd(counters.clamps, 1u);
    rows[row] = uvec2(first, flips << 1 | inside);
}
