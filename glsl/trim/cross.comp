#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `cross`: intersects every linear segment with every scan line that it crosses. One thread a segment.
//
//        v ▲   ─────────── scan line        recorded twice: first counted (INSERT false), then, when
//          │      b ●                       the rows have their places, written (INSERT true)
//          │   ────╱──────                  bottom-open, top-closed: v_a < v <= v_b, so a line through
//          │   a ●                          a shared vertex counts one crossing, and a touch 0 or 2
//
// A scan line has a row in each visible bin (u_bins.glsl). A crossing there adds to the row's winding, from which pass
// `carry` computes the winding at the start of the next bin's row.
//
// An intercept is u as order-preserving bits, its lowest bit the direction: 1 upwards.
// Twin: src/twin/cross.rs.
#include "scene.glsl"

layout(constant_id = 23) const bool INSERT = false;
// Strips of some face have several bins.
layout(constant_id = 1) const bool SCENE_HAS_BINS = false;
// Pass `operand_patch` reads the cells that trim curves cross.
layout(constant_id = 26) const bool MARKS_BORDERS = false;

layout(local_size_x = 128) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
// texels: a driver fetches them at once, but gathers words of storage buffers one by one
layout(binding = 1) uniform usamplerBuffer face_instances;
layout(binding = 2) uniform usamplerBuffer faces;
layout(binding = 3) uniform usamplerBuffer curves;
layout(binding = 4) uniform samplerBuffer curve_points;
layout(binding = 5) uniform usamplerBuffer curve_instances; // the placed face of each
layout(binding = 6) uniform usamplerBuffer strips;
layout(binding = 7) uniform usamplerBuffer segment_starts;
layout(binding = 8) uniform usamplerBuffer row_starts;
layout(scalar, binding = 9) buffer RowCounts { uint row_counts[]; };
layout(scalar, binding = 10) writeonly buffer Intercepts { uint intercepts[]; };
layout(scalar, binding = 11) buffer BorderCells { uint border_cells[]; }; // four words a band, with MARKS_BORDERS
layout(scalar, binding = 12) buffer RowWindings { int row_windings[]; }; // with SCENE_HAS_BINS

#include "u_bins.glsl"
#include "border_cells.glsl"
#include "curve.glsl"
#include "curves.glsl"
#include "faces.glsl"
#include "ordered.glsl"
#include "words.glsl"

uint first_segment(uint curve_instance) { return word_at(segment_starts, curve_instance); }

// The curve instance that contains segment `segment`.
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

// Marks the bands of a bin from `lo` to `hi` of its strip, 0 to 1, clamped to the strip.
void mark(uint bin_instance, float lo, float hi, uvec4 columns) {
    float last_band = float(BORDER_BANDS - 1u);
    uint first = uint(clamp(floor(lo * float(BORDER_BANDS)), 0.0, last_band));
    uint last = uint(clamp(floor(hi * float(BORDER_BANDS)), 0.0, last_band));
    for (uint band = first; band <= last; ++band) {
        uint at = 4u * (bin_instance * BORDER_BANDS + band);
        for (uint word = 0u; word < 4u; ++word) {
            if (columns[word] != 0u) atomicOr(border_cells[at + word], columns[word]);
        }
    }
}

void main() {
    uint segment = thread_number();
    uint total = first_segment(frame.curve_count);
    if (segment >= total) return;
    uint curve_instance = curve_of(segment);
    uint first_of_curve = first_segment(curve_instance);
    uint n = first_segment(curve_instance + 1u) - first_of_curve;
    uint i = segment - first_of_curve;
    FaceInstance fi = face_instance_at(word_at(curve_instances, curve_instance));
    Face face = face_at(fi.face);
    Curve curve = curve_at(face.first_curve + curve_instance - fi.first_curve);
    vec2 a = curve_point(curve, i, n);
    vec2 b = curve_point(curve, i + 1u, n);
    uint upwards = a.y < b.y ? 1u : 0u;
    if (upwards == 0u) {
        vec2 swap = a;
        a = b;
        b = swap;
    }
    float strip_n = float(strip_count(face.strips));
    uint bins = bin_count(face.strips);
    uint first = uint(clamp(floor(a.y * strip_n), 0.0, strip_n - 1.0));
    uint last = uint(clamp(floor(b.y * strip_n), 0.0, strip_n - 1.0));
    float left = min(a.x, b.x);
    float right = max(a.x, b.x);
    for (uint k = first; k <= last; ++k) {
        uint bin_instance = fi.first_bin + k * bins;
        StripRows rows = strip_rows(strips, bin_instance);
        if (rows.lines == 0u) continue;
        // right of all visible bins, or part of a loop that is left of all of them
        if (SCENE_HAS_BINS && (bin_of(left, bins) > last_bin(rows) || bin_of(curve.range_u.y, bins) < rows.first_bin)) continue;
        float mu = float(rows.lines);
        precise float low = a.y * strip_n - float(k);
        precise float high = b.y * strip_n - float(k);
        if (!INSERT && MARKS_BORDERS) {
            precise float around = 0.5 / mu + BAND_ROUNDING;
            precise float below = low - around;
            precise float above = high + around;
            uint last_marked = min(bin_of(right, bins), last_bin(rows));
            for (uint bin = max(bin_of(left, bins), rows.first_bin); bin <= last_marked; ++bin) {
                uvec4 columns = columns_between(within_bin(left, bin, bins), within_bin(right, bin, bins));
                mark(bin_instance + bin, below, above, columns);
            }
        }
        // one line too many on each side: the comparison below decides
        float lowest = floor(low * mu - 0.5);
        float highest = ceil(high * mu - 0.5);
        if (highest < 0.0 || lowest > mu - 1.0) continue;
        uint from = uint(max(lowest, 0.0));
        uint to = uint(min(highest, mu - 1.0));
        for (uint line = from; line <= to; ++line) {
            precise float v = (float(k) + (float(line) + 0.5) / mu) / strip_n;
            if (!(a.y < v && v <= b.y)) continue;
            precise float u = a.x + (v - a.y) / (b.y - a.y) * (b.x - a.x);
            uint intercept = ordered_bits(clamp(u, left, right)) & ~1u;
            uint row = rows.first + line;
            if (SCENE_HAS_BINS) {
                uint bin = bin_of(from_ordered(intercept), bins);
                if (bin > last_bin(rows)) continue;
                row = row_of(rows, line, bin);
            }
            if (row >= frame.row_capacity) continue;
            if (!INSERT) {
                atomicAdd(row_counts[row], 1u);
                if (SCENE_HAS_BINS && rows.bins > 1u) atomicAdd(row_windings[row], upwards != 0u ? 1 : -1);
            } else {
                // counting down, so that the counts need not be cleared in between
                uint place = atomicAdd(row_counts[row], 0xffffffffu) - 1u;
                uint at = word_at(row_starts, row) + place;
                if (at < frame.intercept_capacity) intercepts[at] = intercept | upwards;
            }
        }
    }
}
