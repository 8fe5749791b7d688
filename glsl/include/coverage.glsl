// How much of a pixel a trimmed face covers, from its exact arcs. Twin of src/twin/coverage.rs, where the formula is
// derived. Needs exact.glsl, whose cells hold arcs along scan lines, too.
#ifndef COVERAGE_GLSL
#define COVERAGE_GLSL

struct Cover {
    float share;  // of the pixel
    vec2 outward; // the border in the pixel, turned a quarter away from the face and added up, pixels
    bool cut;     // a border runs through the pixel
};

const uint MOST_CELLS = 64u;     // that a pixel is asked in
const uint CHORDS = 8u;          // of a bent arc, in one cell
const uint ROOT_STEPS = 40u;     // every second one halves
const float ROOT_PX = 1e-3;      // where an arc enters a cell, in the pixel's box

// Area of the pixel that a ray from its centre sweeps, from (1, 0) to `d`.
float swept(vec2 d) {
    if (d.x == 0.0 && d.y == 0.0) return 0.0;
    precise float right = (d.x > 0.0 ? 0.0 : 0.5) + 0.125 * (d.y / d.x);
    precise float up = (d.y > 0.0 ? 0.25 : 0.75) - 0.125 * (d.x / d.y);
    return abs(d.y) <= abs(d.x) ? right : up;
}

// What a ray from the centre sweeps along a chord; positive when it turns as (1, 0) does to (0, 1).
float swept_along(vec2 a, vec2 b) {
    precise float turn = swept(b) - swept(a);
    turn = turn - floor(turn + 0.5);
    return turn;
}

// Whether a point on an arc counts as left of it, as it runs from its lower end to its higher one.
bool left_of(ExactArc arc, vec2 uv) {
    if (arc.low.y < uv.y && uv.y <= arc.high.y) return arc_right(arc, uv);
    return (uv.y > arc.high.y) == (arc.high.x > arc.low.x);
}

// The part of a chord that is in the pixel. Source: Y.-D. Liang, B. A. Barsky, A new concept and method for line
// clipping, ACM TOG 3 (1), 1984.
bool clip_to_pixel(inout vec2 a, inout vec2 b) {
    precise vec2 d = b - a;
    float enter = 0.0;
    float leave = 1.0;
    for (uint axis = 0u; axis < 2u; ++axis) {
        if (d[axis] == 0.0) {
            if (abs(a[axis]) > 0.5) return false;
            continue;
        }
        precise float first = (-0.5 - a[axis]) / d[axis];
        precise float last = (0.5 - a[axis]) / d[axis];
        enter = max(enter, min(first, last));
        leave = min(leave, max(first, last));
    }
    if (!(enter < leave)) return false;
    precise vec2 begin = a + d * enter;
    precise vec2 end = leave < 1.0 ? a + d * leave : b;
    a = clamp(begin, -0.5, 0.5);
    b = clamp(end, -0.5, 0.5);
    return true;
}

// Parameter at which a coordinate of an arc, relative to its lower end, becomes `x`, where both are within `slack`;
// 0 or 1 beyond its ends.
float arc_reach(ExactArc arc, uint axis, float x, vec2 slack) {
    precise vec2 chord = arc.high - arc.low;
    vec2 way = vec2(chord.x < 0.0 ? -1.0 : 1.0, chord.y < 0.0 ? -1.0 : 1.0);
    float to = way[axis] * x;
    vec2 a = vec2(0.0);
    vec2 b = way * chord;
    if (!(to > a[axis])) return 0.0;
    if (!(to < b[axis])) return 1.0;
    precise float straight = to / b[axis];
    if ((arc.shape & ARC_DEGREE) <= 1u) return straight;
    float ta = 0.0;
    float tb = 1.0;
    for (uint step_ = 0u; step_ < ROOT_STEPS && any(greaterThan(b - a, slack)); ++step_) {
        precise float share = (step_ & 1u) == 0u ? (to - a[axis]) / (b[axis] - a[axis]) : 0.5;
        precise float t = ta + (tb - ta) * share;
        if (!(t > ta && t < tb)) {
            t = 0.5 * (ta + tb);
            if (!(t > ta && t < tb)) break;
        }
        vec2 q = clamp(way * arc_point(arc, t), a, b);
        if (q[axis] >= to) {
            tb = t;
            b = q;
        } else {
            ta = t;
            a = q;
        }
    }
    precise float last = ta + (tb - ta) * ((to - a[axis]) / (b[axis] - a[axis]));
    return b[axis] > a[axis] ? last : tb;
}

// Parameters between which an arc is in a box, whose corners are relative to its lower end.
vec2 arc_within(ExactArc arc, vec2 lo, vec2 hi, vec2 slack) {
    vec2 range = vec2(0.0, 1.0);
    for (uint axis = 0u; axis < 2u; ++axis) {
        if (arc.high[axis] == arc.low[axis]) {
            if (lo[axis] > 0.0 || hi[axis] < 0.0) return vec2(1.0, 0.0);
            continue;
        }
        bool falls = arc.high[axis] < arc.low[axis];
        range.x = max(range.x, arc_reach(arc, axis, falls ? hi[axis] : lo[axis], slack));
        range.y = min(range.y, arc_reach(arc, axis, falls ? lo[axis] : hi[axis], slack));
    }
    return range;
}

vec2 arc_at(ExactArc arc, float t) {
    precise vec2 straight = (arc.high - arc.low) * t;
    if (t >= 1.0) return arc.high - arc.low;
    return (arc.shape & ARC_DEGREE) <= 1u ? straight : arc_point(arc, t);
}

// What of the pixel around `uv` is inside. `along`: how far the pixel moves with u, and with v.
Cover exact_cover(uint face, vec2 uv, mat2 along) {
    int winding = exact_winding(face, uv);
    Cover cover = Cover(winding != 0 ? 1.0 : 0.0, vec2(0.0), false);
    precise float det = along[0].x * along[1].y - along[0].y * along[1].x;
    // of the pixel's box in the domain
    precise vec2 reach = vec2(abs(along[1].y) + abs(along[1].x), abs(along[0].y) + abs(along[0].x)) * (0.5 / abs(det));
    vec2 lo = uv - reach;
    vec2 hi = uv + reach;
    ExactFace f = exact_face_at(face);
    uint end = f.first_band + f.band_count;
    if (f.band_count < 2u || !(lo.x <= hi.x && lo.y <= hi.y)) return cover;
    float hidden = 0.0;
    uint asked = 0u;
    for (uint band = exact_band(f, lo.y); band < end; ++band) {
        float bottom = exact_band_at(band - 1u).top;
        if (!(bottom <= hi.y)) break;
        uint first = exact_band_at(band - 1u).end;
        uint last = exact_band_at(band).end;
        for (uint cell = exact_cell(first, last, lo.x); cell < last; ++cell) {
            float left = cell > first ? exact_cell_at(cell - 1u).right : lo.x;
            if (!(left <= hi.x)) break;
            if (++asked > MOST_CELLS) return Cover(cover.share, vec2(0.0), false);
            ExactCell c = exact_cell_at(cell);
            vec2 from = max(lo, vec2(left, bottom));
            vec2 to = min(hi, vec2(c.right, exact_band_at(band).top));
            for (uint i = 0u; i < c.count; ++i) {
                ExactArc arc = exact_arc_at(exact_entry_at(c.first + i));
                vec2 range = arc_within(arc, from - arc.low, to - arc.low, ROOT_PX * reach);
                if (!(range.x < range.y)) continue;
                float way = (arc.shape & ARC_UP) != 0u ? 1.0 : -1.0;
                uint chords = (arc.shape & ARC_DEGREE) <= 1u ? 1u : CHORDS;
                bool in_row = arc.low.y < uv.y && uv.y <= arc.high.y;
                precise vec2 base = arc.low - uv;
                precise vec2 p = base + arc_at(arc, range.x);
                precise vec2 a = along[0] * p.x + along[1] * p.y;
                for (uint k = 1u; k <= chords; ++k) {
                    precise float t = range.x + (range.y - range.x) * (float(k) / float(chords));
                    bool crosses = in_row && p.y < 0.0;
                    p = base + arc_at(arc, k == chords ? range.y : t);
                    crosses = crosses && p.y >= 0.0;
                    precise vec2 b = along[0] * p.x + along[1] * p.y;
                    vec2 begin = a;
                    vec2 end_ = b;
                    a = b;
                    if (!clip_to_pixel(begin, end_)) continue;
                    precise vec2 d = end_ - begin;
                    precise float off = begin.x * end_.y - begin.y * end_.x;
                    float sweep = swept_along(begin, end_);
                    bool left_ = (sweep > 0.0) == (det > 0.0);
                    if (abs(sweep) == 0.5) {
                        // the centre is on it: as the exact test has it
                        left_ = left_of(arc, uv);
                        sweep = left_ == (det > 0.0) ? 0.5 : -0.5;
                    } else if (crosses && left_ != arc_right(arc, uv)) {
                        winding += int(left_ ? way : -way); // the centre is between the chord and its arc
                    }
                    precise float sum = hidden + way * (sweep - 0.5 * off);
                    hidden = sum;
                    cover.outward += way * vec2(d.y, -d.x);
                    cover.cut = true;
                }
            }
        }
    }
    float turned = det < 0.0 ? -1.0 : 1.0;
    precise float mean = float(winding) - turned * hidden;
    cover.outward *= mean < 0.0 ? -turned : turned;
    cover.share = min(abs(mean), 1.0);
    return cover;
}

#endif
