#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `cross`: every linear segment meets every scan line that it crosses. One thread a segment.
//
//        v ▲   ─────────── scan line        recorded twice: first counted (INSERT false), then, when
//          │      b ●                       the rows have found their places, written (INSERT true)
//          │   ────╱──────                  bottom-open, top-closed: v_a < v <= v_b, so a line through
//          │   a ●                          a shared vertex counts one crossing, and a touch 0 or 2
//
// An intercept is u as order-preserving bits, its lowest bit the direction: 1 upwards.
// Twin: src/twin/cross.rs.
#include "scene.glsl"

layout(constant_id = 1) const bool INSERT = false;

layout(local_size_x = 128) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
// texels, which a driver fetches at once where it gathers words of storage buffers one by one
layout(binding = 1) uniform usamplerBuffer face_instances;
layout(binding = 2) uniform usamplerBuffer faces;
layout(binding = 3) uniform usamplerBuffer curves;
layout(binding = 4) uniform samplerBuffer curve_points;
layout(binding = 5) uniform usamplerBuffer curve_items; // the placed face of each
layout(binding = 6) uniform usamplerBuffer line_starts;
layout(binding = 7) uniform usamplerBuffer segment_starts;
layout(binding = 8) uniform usamplerBuffer row_starts;
layout(scalar, binding = 9) buffer RowCounts { uint row_counts[]; };
layout(scalar, binding = 10) writeonly buffer Intercepts { uint intercepts[]; };
layout(scalar, binding = 11) buffer BorderCells { uint border_cells[]; }; // four words a band

#include "border_cells.glsl"
#include "curve.glsl"
#include "curves.glsl"
#include "faces.glsl"
#include "words.glsl"

uint first_segment(uint item) { return word_at(segment_starts, item); }

// The curve item whose segments hold `segment`.
uint curve_of(uint segment) {
    uint lo = 0u;
    uint hi = frame.curve_count;
    while (hi - lo > 1u) {
        uint mid = (lo + hi) / 2u;
        if (first_segment(mid) <= segment) lo = mid;
        else hi = mid;
    }
    return lo;
}

// Marks the bands of a strip from `lo` to `hi`, 0 to 1, as far as it has them.
void mark(uint strip, float lo, float hi, uvec4 columns) {
    float last_band = float(BORDER_BANDS - 1u);
    uint first = uint(clamp(floor(lo * float(BORDER_BANDS)), 0.0, last_band));
    uint last = uint(clamp(floor(hi * float(BORDER_BANDS)), 0.0, last_band));
    for (uint band = first; band <= last; ++band) {
        uint at = 4u * (strip * BORDER_BANDS + band);
        for (uint word = 0u; word < 4u; ++word) {
            if (columns[word] != 0u) atomicOr(border_cells[at + word], columns[word]);
        }
    }
}

uint ordered_bits(float u) {
    uint bits = floatBitsToUint(u);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

void main() {
    uint segment = gl_GlobalInvocationID.x;
    uint total = first_segment(frame.curve_count);
    if (segment >= total) return;
    uint item = curve_of(segment);
    uint first_of_item = first_segment(item);
    uint n = first_segment(item + 1u) - first_of_item;
    uint i = segment - first_of_item;
    FaceInstance fi = face_instance_at(word_at(curve_items, item));
    Face face = face_at(fi.face);
    Curve curve = curve_at(face.first_curve + item - fi.first_curve);
    vec2 a = curve_point(curve, i, n);
    vec2 b = curve_point(curve, i + 1u, n);
    uint upwards = a.y < b.y ? 1u : 0u;
    if (upwards == 0u) {
        vec2 swap = a;
        a = b;
        b = swap;
    }
    float strips = float(face.strip_count);
    uint first = uint(clamp(floor(a.y * strips), 0.0, strips - 1.0));
    uint last = uint(clamp(floor(b.y * strips), 0.0, strips - 1.0));
    uvec4 columns = columns_between(min(a.x, b.x), max(a.x, b.x));
    for (uint k = first; k <= last; ++k) {
        uint base = word_at(line_starts, fi.first_strip + k);
        uint count = word_at(line_starts, fi.first_strip + k + 1u) - base;
        if (count == 0u) continue;
        float mu = float(count);
        precise float low = a.y * strips - float(k);
        precise float high = b.y * strips - float(k);
        if (!INSERT) {
            precise float around = 0.5 / mu + BAND_ROUNDING;
            precise float below = low - around;
            precise float above = high + around;
            mark(fi.first_strip + k, below, above, columns);
        }
        // one line too many on each side: the comparison below decides
        float lowest = floor(low * mu - 0.5);
        float highest = ceil(high * mu - 0.5);
        if (highest < 0.0 || lowest > mu - 1.0) continue;
        uint from = uint(max(lowest, 0.0));
        uint to = uint(min(highest, mu - 1.0));
        for (uint line = from; line <= to; ++line) {
            precise float v = (float(k) + (float(line) + 0.5) / mu) / strips;
            if (!(a.y < v && v <= b.y)) continue;
            uint row = base + line;
            if (row >= frame.row_capacity) continue;
            if (!INSERT) {
                atomicAdd(row_counts[row], 1u);
            } else {
                // counting down, so that the counts need not be cleared in between
                uint place = atomicAdd(row_counts[row], 0xffffffffu) - 1u;
                precise float u = a.x + (v - a.y) / (b.y - a.y) * (b.x - a.x);
                u = clamp(u, min(a.x, b.x), max(a.x, b.x));
                uint at = word_at(row_starts, row) + place;
                if (at < frame.intercept_capacity) intercepts[at] = (ordered_bits(u) & ~1u) | upwards;
            }
        }
    }
}
