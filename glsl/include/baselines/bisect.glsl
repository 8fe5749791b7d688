// Trimming by bisection of monotone pieces in every pixel. Data structure and twin: src/baselines/bisect.rs.
#ifndef BISECT_GLSL
#define BISECT_GLSL

struct BisectFace {
    uint first_band;
    uint band_count;
    uint steps;
};

struct BisectBand {
    float v;
    uint first_cell;
};

struct BisectCell {
    float u_lo;
    float u_hi;
    uint first;
    uint count; // of pieces | parity left of the cell << 30 | parity right of it << 31
};

struct BisectPiece {
    vec2 start;
    vec2 end;
    uint first;
    uint degree;
};

#include "words.glsl"

// texels, as those of exact.glsl
layout(binding = TRIM_BINDING + 0) uniform usamplerBuffer bisect_faces;  // three a face
layout(binding = TRIM_BINDING + 1) uniform usamplerBuffer bisect_bands;  // one a band
layout(binding = TRIM_BINDING + 2) uniform usamplerBuffer bisect_cells;  // one a cell
layout(binding = TRIM_BINDING + 3) uniform usamplerBuffer bisect_lists;  // one an entry
layout(binding = TRIM_BINDING + 4) uniform usamplerBuffer bisect_pieces; // three a piece
layout(binding = TRIM_BINDING + 5) uniform samplerBuffer bisect_points;  // three a control point

BisectFace bisect_face_at(uint i) {
    uint at = i * 3u;
    return BisectFace(word_at(bisect_faces, at), word_at(bisect_faces, at + 1u), word_at(bisect_faces, at + 2u));
}

BisectBand bisect_band_at(uint i) {
    uvec2 band = texelFetch(bisect_bands, int(i)).xy;
    return BisectBand(uintBitsToFloat(band.x), band.y);
}

BisectCell bisect_cell_at(uint i) {
    uvec4 cell = texelFetch(bisect_cells, int(i));
    return BisectCell(uintBitsToFloat(cell.x), uintBitsToFloat(cell.y), cell.z, cell.w);
}

BisectPiece bisect_piece_at(uint i) {
    int at = int(word_at(bisect_lists, i)) * 3;
    uvec2 start = texelFetch(bisect_pieces, at).xy;
    uvec2 end = texelFetch(bisect_pieces, at + 1).xy;
    uvec2 rest = texelFetch(bisect_pieces, at + 2).xy;
    return BisectPiece(uintBitsToFloat(start), uintBitsToFloat(end), rest.x, rest.y);
}

vec3 bisect_point_at(uint i) {
    return numbers_at(bisect_points, i * 3u);
}

vec2 bisect_point(BisectPiece piece, float t) {
    float s = 1.0 - t;
    float f = 1.0;
    float c = 1.0;
    vec3 sum = bisect_point_at(piece.first) * s;
    for (uint k = 1u; k < piece.degree; ++k) {
        f *= t;
        c *= float(piece.degree - k + 1u) / float(k);
        sum = (sum + bisect_point_at(piece.first + k) * (f * c)) * s;
    }
    sum += bisect_point_at(piece.first + piece.degree) * (f * t);
    return sum.xy / sum.z;
}

// Whether the piece crosses the point's scan line at the point or left of it.
bool bisect_left(BisectPiece piece, vec2 p, uint steps) {
    vec2 a = piece.start;
    vec2 b = piece.end;
    if ((a.y >= p.y) == (b.y >= p.y)) return false;
    vec2 lo = min(a, b);
    vec2 hi = max(a, b);
    float ta = 0.0;
    float tb = 1.0;
    uint step_ = piece.degree <= 1u ? steps : 0u;
    for (; step_ < steps && p.x >= min(a.x, b.x) && p.x < max(a.x, b.x); ++step_) {
        float t = 0.5 * (ta + tb);
        vec2 m = clamp(bisect_point(piece, t), lo, hi);
        bool like_a = (m.y >= p.y) == (a.y >= p.y);
        a = like_a ? m : a;
        ta = like_a ? t : ta;
        b = like_a ? b : m;
        tb = like_a ? tb : t;
    }
    if (p.x < min(a.x, b.x)) return false;
    if (p.x >= max(a.x, b.x)) return true;
    return a.x + (b.x - a.x) * ((p.y - a.y) / (b.y - a.y)) <= p.x;
}

// The band of v, and its last cell that begins at or left of u; false if there is none: the point is outside.
bool bisect_cell(BisectFace own, vec2 uv, out uint band, out uint cell) {
    // the number of bands that begin below the point
    uint lo = 0u;
    uint hi = own.band_count == 0u ? 0u : own.band_count + 1u;
    uint ends = hi;
    while (lo < hi) {
        uint mid = (lo + hi) / 2u;
        if (bisect_band_at(own.first_band + mid).v < uv.y) lo = mid + 1u;
        else hi = mid;
    }
    band = own.first_band + lo - 1u;
    cell = 0u;
    if (lo == 0u || lo == ends) return false;
    uint first = bisect_band_at(band).first_cell;
    lo = first;
    hi = bisect_band_at(band + 1u).first_cell;
    while (lo < hi) {
        uint mid = (lo + hi) / 2u;
        if (bisect_cell_at(mid).u_lo <= uv.x) lo = mid + 1u;
        else hi = mid;
    }
    cell = lo - 1u;
    return lo != first;
}

// For a box within a band: whether it lies between two cells or beyond all.
uint trim_area(FaceInstance fi, Face face, vec2 lo, vec2 hi) {
    BisectFace own = bisect_face_at(fi.face);
    uint band;
    uint cell;
    if (own.band_count == 0u || hi.y <= bisect_band_at(own.first_band).v) return TRIM_OUT;
    if (lo.y > bisect_band_at(own.first_band + own.band_count).v) return TRIM_OUT;
    bool right = bisect_cell(own, hi, band, cell);
    if (band >= own.first_band + own.band_count || bisect_band_at(band).v >= lo.y) return TRIM_MIXED;
    if (!right) return TRIM_OUT;
    if (lo.x <= bisect_cell_at(cell).u_hi) return TRIM_MIXED;
    return (bisect_cell_at(cell).count >> 31) != 0u ? TRIM_IN : TRIM_OUT;
}

bool trim_inside(FaceInstance fi, Face face, vec2 uv) {
    BisectFace own = bisect_face_at(fi.face);
    uint band;
    uint at;
    if (!bisect_cell(own, uv, band, at)) return false;
    BisectCell cell = bisect_cell_at(at);
    if (uv.x > cell.u_hi) return (cell.count >> 31) != 0u;
    uint count = cell.count & 0x3fffffffu;
    bool inside = ((cell.count >> 30) & 1u) != 0u;
    for (uint k = 0u; k < count; ++k) {
        BisectPiece piece = bisect_piece_at(cell.first + k);
        inside = inside != bisect_left(piece, uv, own.steps);
    }
    return inside;
}

#endif
