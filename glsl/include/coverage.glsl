// The area of a pixel that a trimmed face covers, from its exact arcs. Twin of src/twin/coverage.rs, which derives the
// formula. Needs exact.glsl, whose lists also contain arcs along scan lines.
#ifndef COVERAGE_GLSL
#define COVERAGE_GLSL

struct Cover {
    float share;  // of the pixel
    vec2 outward; // sum of the border's pieces in the pixel, turned by 90 degrees away from the face; pixels
    bool cut;     // a border runs through the pixel
};

const uint MOST_CELLS = 128u; // most cells for one pixel
const uint CHORDS = 8u;      // of a curved arc, in one cell

// Area of the pixel that a ray from its centre sweeps, from (1, 0) to `d`.
float swept(vec2 d) {
    if (d.x == 0.0 && d.y == 0.0) return 0.0;
    precise float right = (d.x > 0.0 ? 0.0 : 0.5) + 0.125 * (d.y / d.x);
    precise float up = (d.y > 0.0 ? 0.25 : 0.75) - 0.125 * (d.x / d.y);
    return abs(d.y) <= abs(d.x) ? right : up;
}

// The area that a ray from the centre sweeps along a chord; positive if it turns from (1, 0) to (0, 1).
float swept_along(vec2 a, vec2 b) {
    precise float turn = swept(b) - swept(a);
    turn = turn - floor(turn + 0.5);
    return turn;
}

// Whether a point on an arc counts as left of it, for an arc that runs from its lower to its higher end.
bool left_of(ExactArc arc, vec2 uv) {
    if (arc.low.y < uv.y && uv.y <= arc.high.y) return arc_right(arc, uv);
    return (uv.y > arc.high.y) == (arc.high.x > arc.low.x);
}

// Weight of an arc's corner, for weights 1 at the ends; 0 for a straight arc.
float arc_weight(ExactArc arc) {
    precise float weight = 0.5 * sqrt(arc.fullness);
    return weight;
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

// Parameter at which a coordinate of an arc, relative to its lower end, is `x`; 0 or 1 beyond its ends.
float arc_reach(ExactArc arc, uint axis, float x) {
    float chord = exact_chord(arc)[axis];
    float way = chord < 0.0 ? -1.0 : 1.0;
    float to = way * x;
    float corner = way * arc.corner[axis];
    float end = way * chord;
    if (!(to > 0.0)) return 0.0;
    if (!(to < end)) return 1.0;
    precise float straight = to / end;
    if (arc.fullness == 0.0) return straight;
    precise float b = arc_weight(arc) * (corner - to);
    precise float left = end - to;
    precise float root = sqrt(b * b + left * to);
    // for t = r / (1 + r), the sum without cancellation
    precise float above = to / (to + (b + root));
    precise float below = (root - b) / ((root - b) + left);
    return b > 0.0 ? above : below;
}

// The parameters between which an arc lies in a box, whose corners are relative to the arc's lower end. The box
// excludes its upper and right side, so an arc along a common side of two cells counts once.
vec2 arc_within(ExactArc arc, vec2 lo, vec2 hi) {
    vec2 range = vec2(0.0, 1.0);
    for (uint axis = 0u; axis < 2u; ++axis) {
        if (arc.high[axis] == arc.low[axis]) {
            if (lo[axis] > 0.0 || hi[axis] <= 0.0) return vec2(1.0, 0.0);
            continue;
        }
        bool falls = arc.high[axis] < arc.low[axis];
        range.x = max(range.x, arc_reach(arc, axis, falls ? hi[axis] : lo[axis]));
        range.y = min(range.y, arc_reach(arc, axis, falls ? lo[axis] : hi[axis]));
    }
    return range;
}

// A point of an arc, relative to its lower end.
vec2 arc_at(ExactArc arc, float t) {
    vec2 chord = exact_chord(arc);
    if (t >= 1.0) return chord;
    precise vec2 straight = chord * t;
    if (arc.fullness == 0.0) return straight;
    precise float s = 1.0 - t;
    precise float corner = 2.0 * arc_weight(arc) * (s * t);
    precise float end = t * t;
    precise float sum = s * s + corner + end;
    precise vec2 point = (corner * arc.corner + end * chord) / sum;
    return point;
}

// The part of the pixel around `uv` that is inside. `along`: change of the pixel with u, and with v.
Cover exact_cover(uint face, vec2 uv, mat2 along) {
    int winding = exact_winding(face, uv);
    Cover cover = Cover(winding != 0 ? 1.0 : 0.0, vec2(0.0), false);
    precise float det = along[0].x * along[1].y - along[0].y * along[1].x;
    // half size of the pixel's box in the domain
    precise vec2 reach = vec2(abs(along[1].y) + abs(along[1].x), abs(along[0].y) + abs(along[0].x)) * (0.5 / abs(det));
    vec2 lo = uv - reach;
    vec2 hi = uv + reach;
    if (!(lo.x <= hi.x && lo.y <= hi.y)) return cover;
    ExactGrid grid = exact_grid(face);
    float hidden = 0.0;
    uint asked = 0u;
    // one list for the whole pixel, if possible: that of the centre's cell
    vec2 middle = exact_index(grid, uv);
    ExactCell cell_of_middle = exact_cell(grid, middle);
    vec2 middle_part = exact_part(grid, uv, middle, exact_halvings(cell_of_middle));
    ExactList list_of_middle = exact_list_of(grid, cell_of_middle, middle, middle_part);
    bool one = holds_for(list_of_middle, lo) && holds_for(list_of_middle, hi);
    vec2 first = one ? middle : exact_index(grid, lo);
    vec2 last = one ? middle : exact_index(grid, hi);
    for (vec2 index = first; index.y <= last.y;
         index = index.x < last.x ? vec2(index.x + 1.0, index.y) : vec2(first.x, index.y + 1.0)) {
        ExactCell cell = exact_cell(grid, index);
        vec2 from_part = one ? middle_part : exact_part(grid, lo, index, exact_halvings(cell));
        vec2 to_part = one ? middle_part : exact_part(grid, hi, index, exact_halvings(cell));
        for (vec2 part = from_part; part.y <= to_part.y;
             part = part.x < to_part.x ? vec2(part.x + 1.0, part.y) : vec2(from_part.x, part.y + 1.0)) {
            if (++asked > MOST_CELLS) return Cover(cover.share, vec2(0.0), false);
            ExactList list = exact_list_of(grid, cell, index, part);
            vec2 from = one ? lo : max(lo, list.lo);
            vec2 to = one ? hi : min(hi, list.hi);
            bool more = true;
            for (uint i = list.first; more; ++i) {
                ExactArc arc = exact_arc_at(i);
                more = (arc.shape & ARC_LAST) == 0u;
                precise vec2 low = from - arc.low;
                precise vec2 high = to - arc.low;
                vec2 range = arc_within(arc, low, high);
                if (!(range.x < range.y)) continue;
                float way = (arc.shape & ARC_UP) != 0u ? 1.0 : -1.0;
                uint chords = arc.fullness == 0.0 ? 1u : CHORDS;
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
                        // the centre is on it: decide as the exact test does
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
