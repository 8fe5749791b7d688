// The exact trim test: band, cell, and the few arcs that the cell holds. Twin of
// src/twin/exact.rs; what the structures mean stands in src/trim/exact.
//
//   face ──▶ bands: binary search in v ──▶ cells: binary search in u ──▶ winding + entries ──▶ arcs ──▶ points
//
// Whoever includes this defines EXACT_BINDING, where its six buffers begin.
#ifndef EXACT_GLSL
#define EXACT_GLSL

struct ExactFace {
    uint first_band;
    uint band_count;
};

struct ExactBand {
    float top;
    uint end; // one past its last cell
};

struct ExactCell {
    float right;
    int winding; // by what lies right of it
    uint first;
    uint count;
};

struct ExactArc {
    vec2 low;
    vec2 high;
    vec2 hull;  // least and largest chord x (control point - low)
    uint first; // float in exact_points, three a control point
    uint shape; // degree, 1 for a straight arc; ARC_UP: the loop runs from low to high
};

#include "words.glsl"

// texels, which a driver fetches at once where it gathers words of storage buffers one by one
layout(binding = EXACT_BINDING + 0) uniform usamplerBuffer exact_faces;   // one a face
layout(binding = EXACT_BINDING + 1) uniform usamplerBuffer exact_bands;   // one a band
layout(binding = EXACT_BINDING + 2) uniform usamplerBuffer exact_cells;   // one a cell
layout(binding = EXACT_BINDING + 3) uniform usamplerBuffer exact_entries; // one an entry
layout(binding = EXACT_BINDING + 4) uniform usamplerBuffer exact_arcs;    // two an arc
layout(binding = EXACT_BINDING + 5) uniform samplerBuffer exact_points;   // three a control point

ExactFace exact_face_at(uint i) {
    uvec2 face = texelFetch(exact_faces, int(i)).xy;
    return ExactFace(face.x, face.y);
}

ExactBand exact_band_at(uint i) {
    uvec2 band = texelFetch(exact_bands, int(i)).xy;
    return ExactBand(uintBitsToFloat(band.x), band.y);
}

ExactCell exact_cell_at(uint i) {
    uvec4 cell = texelFetch(exact_cells, int(i));
    return ExactCell(uintBitsToFloat(cell.x), int(cell.y), cell.z, cell.w);
}

// Of an entry.
ExactArc exact_arc_at(uint entry) {
    int at = int(entry >> 2u) * 2;
    uvec4 ends = texelFetch(exact_arcs, at);
    uvec4 rest = texelFetch(exact_arcs, at + 1);
    vec4 low_high = uintBitsToFloat(ends);
    return ExactArc(low_high.xy, low_high.zw, uintBitsToFloat(rest.xy), rest.z, rest.w);
}

uint exact_entry_at(uint i) { return word_at(exact_entries, i); }

vec3 exact_point_at(uint i) {
    return numbers_at(exact_points, i);
}

const uint AT_LOW = 1u;  // flags of an entry: a chain leaves the cell from this end of the arc
const uint AT_HIGH = 2u;
const uint AREA_OUT = 0u; // what an area holds
const uint AREA_IN = 1u;
const uint AREA_MIXED = 2u; // or what is not easily told
const uint ARC_DEGREE = 31u;
const uint ARC_UP = 32u;
const uint MAX_STEPS = 40u;  // every second one halves: 2^-20 of the arc, in parameter, at the least

// Point of a bent arc, relative to its lower end: Horner's scheme in the Bernstein basis.
vec2 arc_point(ExactArc arc, float t) {
    uint degree = arc.shape & ARC_DEGREE;
    precise float s = 1.0 - t;
    precise float f = 1.0;
    precise float c = 1.0;
    uint at = arc.first;
    precise vec3 sum = exact_point_at(at) * s;
    for (uint k = 1u; k < degree; ++k) {
        at += 3u;
        f = f * t;
        c = c * (float(degree - k + 1u) / float(k));
        sum = (sum + exact_point_at(at) * (f * c)) * s;
    }
    at += 3u;
    sum = sum + exact_point_at(at) * (f * t);
    precise vec2 point = sum.xy / sum.z;
    return point;
}

// Sign of the crossing's place: the arc passes uv.y, low.y < uv.y <= high.y, at some u > uv.x.
bool arc_right(ExactArc arc, vec2 uv) {
    if (uv.x < min(arc.low.x, arc.high.x)) return true;
    if (uv.x >= max(arc.low.x, arc.high.x)) return false;
    if (uv.y == arc.high.y) return arc.high.x > uv.x; // at a flat end the parameter tells nothing
    precise vec2 p = uv - arc.low;
    precise vec2 chord = arc.high - arc.low;
    precise float side = chord.x * p.y - p.x * chord.y;
    if (side > arc.hull.y) return true;
    uint degree = arc.shape & ARC_DEGREE;
    if (side < arc.hull.x || degree <= 1u) return false;
    float ta = 0.0;
    float tb = 1.0;
    vec2 a = vec2(0.0);
    vec2 b = chord;
    for (uint step_ = 0u; step_ < MAX_STEPS; ++step_) {
        precise float share = (step_ & 1u) == 0u ? (p.y - a.y) / (b.y - a.y) : 0.5;
        precise float t = ta + (tb - ta) * share;
        if (!(t > ta && t < tb)) {
            t = 0.5 * (ta + tb);
            if (!(t > ta && t < tb)) break;
        }
        precise vec2 q = clamp(arc_point(arc, t), min(a, b), max(a, b));
        if (q.y >= p.y) {
            tb = t;
            b = q;
        } else {
            ta = t;
            a = q;
        }
        if (p.x < min(a.x, b.x)) return true;
        if (p.x >= max(a.x, b.x)) return false;
    }
    precise float last = (b.x - a.x) * (p.y - a.y) - (p.x - a.x) * (b.y - a.y);
    return last > 0.0;
}

// First band whose top is not below v, of those behind the face's first; one past the last where there is none.
uint exact_band(ExactFace f, float v) {
    uint lo = f.first_band + 1u;
    uint hi = f.first_band + f.band_count;
    while (lo < hi) {
        uint mid = (lo + hi) / 2u;
        if (exact_band_at(mid).top < v) lo = mid + 1u;
        else hi = mid;
    }
    return lo;
}

// First of some cells whose right border is not left of u, or `end`.
uint exact_cell(uint first, uint end, float u) {
    while (first < end) {
        uint mid = (first + end) / 2u;
        if (exact_cell_at(mid).right < u) first = mid + 1u;
        else end = mid;
    }
    return first;
}

// Winding number of the face's loops around uv.
int exact_winding(uint face, vec2 uv) {
    ExactFace f = exact_face_at(face);
    if (f.band_count < 2u || !(uv.y > exact_band_at(f.first_band).top)) return 0;
    uint band = exact_band(f, uv.y);
    if (band >= f.first_band + f.band_count) return 0;
    uint last = exact_band_at(band).end;
    uint cell = exact_cell(exact_band_at(band - 1u).end, last, uv.x);
    if (cell >= last) return 0;
    ExactCell c = exact_cell_at(cell);
    int winding = c.winding;
    for (uint i = 0u; i < c.count; ++i) {
        uint entry = exact_entry_at(c.first + i);
        ExactArc arc = exact_arc_at(entry);
        int direction = (arc.shape & ARC_UP) != 0u ? 1 : -1;
        if ((entry & AT_LOW) != 0u && arc.low.y < uv.y) winding -= direction;
        if ((entry & AT_HIGH) != 0u && arc.high.y < uv.y) winding += direction;
        if (arc.low.y < uv.y && uv.y <= arc.high.y && arc_right(arc, uv)) winding += direction;
    }
    return winding;
}

// Whether all of a box is inside the face, all of it outside, or neither is told by the one cell that holds it. Cells
// with arcs are not asked: a wide machine would do it beside the point by point test, not in its place.
uint exact_area(uint face, vec2 lo, vec2 hi) {
    ExactFace f = exact_face_at(face);
    if (f.band_count < 2u || !(hi.y > exact_band_at(f.first_band).top)) return AREA_OUT;
    uint band = exact_band(f, hi.y);
    if (!(exact_band_at(band - 1u).top < lo.y)) return AREA_MIXED;
    if (band >= f.first_band + f.band_count) return AREA_OUT;
    uint first = exact_band_at(band - 1u).end;
    uint last = exact_band_at(band).end;
    uint cell = exact_cell(first, last, hi.x);
    if (cell > first && !(exact_cell_at(cell - 1u).right < lo.x)) return AREA_MIXED;
    if (cell >= last) return AREA_OUT;
    ExactCell c = exact_cell_at(cell);
    if (c.count > 0u) return AREA_MIXED;
    return c.winding != 0 ? AREA_IN : AREA_OUT;
}

#endif
