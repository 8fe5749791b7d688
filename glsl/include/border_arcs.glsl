// The border near a pixel, by the exact arcs. One list, that of the point's cell, decides the point, the corners of a
// square around it, and the point ahead.
//
//      1 ●─────────● 0      a straight border nearer than the sides has a corner beyond it (SQUARE, gap_radius.glsl)
//        │         │
//        │    ·──▶ │        each arc is fetched once and tested against all points: a point's place in the arc's
//        │         │        triangle is linear, and opposite corners are equally far from the point
//      2 ●─────────● 3
//
// Points beyond the list's box, a quarter of a cell around the cell, remain undecided: testing other cells needs a loop
// around the loop of arcs, which is expensive even if it runs only once. A front does not grow to a border beyond the
// box; the back face behind finds the gap, as with wider gaps. In all other cases an undecided point counts as a
// border, and pass `gap_fill` looks closer. A solid's back that is visible there is drawn, since it is a candidate
// itself.
#ifndef BORDER_ARCS_GLSL
#define BORDER_ARCS_GLSL

#include "border.glsl"
#include "gap_radius.glsl"

// The values of a linear function at all corners, from those at corners 0 and 1; all relative to the point.
vec4 at_corners(vec2 two) { return vec4(two, -two); }

// Winding numbers that an arc adds at the corners, whose v are `v`. `far_u` and `far_v` are the offsets of corners 0
// and 1 from the point, whose place is `place`. The same as arc_winding, up to rounding.
ivec4 corner_windings(ExactArc arc, ArcSides sides, vec3 place, vec4 v, vec2 far_u, vec2 far_v) {
    vec4 middle = place.x + at_corners(sides.to_high.x * far_v - far_u * sides.to_high.y);
    vec4 high = arc.fullness * place.y +
                at_corners(arc.fullness * (far_u * sides.to_corner.y - sides.to_corner.x * far_v));
    vec4 low = place.z + at_corners(sides.back.x * far_v - far_u * sides.back.y);
    bvec4 beyond = greaterThan(middle * max(middle, 0.0), max(low, 0.0) * max(high, 0.0));
    int direction = (arc.shape & ARC_UP) != 0u ? 1 : -1;
    int below = (arc.shape & AT_LOW) != 0u ? direction : 0;
    int above = (arc.shape & AT_HIGH) != 0u ? direction : 0;
    ivec2 within = sides.turned > 0.0 ? ivec2(0, direction) : ivec2(direction, 0);
    ivec4 winding = mix(ivec4(within.x - below), ivec4(within.y - below), beyond);
    winding = mix(winding, ivec4(above - below), greaterThan(v, vec4(arc.high.y)));
    return mix(ivec4(0), winding, greaterThan(v, vec4(arc.low.y)));
}

Border border_at(FacePoint p, float reach, bool from_behind, vec2 ahead, vec2 slope) {
    float side = SQUARE * reach;
    vec2 far_u = side * (vec2(p.dx.x, -p.dx.x) + p.dy.x);
    vec2 far_v = side * (vec2(p.dx.y, -p.dx.y) + p.dy.y);
    vec4 u = p.at.x + at_corners(far_u);
    vec4 v = p.at.y + at_corners(far_v);
    vec2 step_ = ahead.x * p.dx + ahead.y * p.dy;
    vec2 at_ahead = p.at + step_;
    ExactList list = exact_list(p.fi.face, p.at);
    int winding = list.winding;
    int winding_ahead = list.winding;
    ivec4 windings = ivec4(list.winding);
    bool more = true;
    for (uint i = list.first; more; ++i) {
        ExactArc arc = exact_arc_at(i);
        ArcSides sides = arc_sides(arc);
        vec3 place = arc_place_of(arc, sides, p.at);
        vec3 place_ahead = place + arc_place(sides, step_, step_);
        winding += arc_winding(arc, p.at.y, arc_right_at(arc, sides, place, p.at));
        winding_ahead += arc_winding(arc, at_ahead.y, arc_right_of(arc, sides, place_ahead));
        windings += corner_windings(arc, sides, place, v, far_u, far_v);
        more = (arc.shape & ARC_LAST) == 0u;
    }
    vec2 lo = list.lo - list.margin;
    vec2 hi = list.hi + list.margin;
    bvec4 untold = greaterThan(max(max(lo.x - u, u - hi.x), max(lo.y - v, v - hi.y)), vec4(0.0));
    bvec4 inside = notEqual(windings, ivec4(0));
    bool solid = (p.face.flags & FACE_SOLID) != 0u;
    Border border = Border(winding != 0, true, false, NO_BORDER);
    border.goes_on = winding_ahead != 0 && holds_for(list, at_ahead);
    if (reach > 0.0) {
        bvec4 there = mix(inside, bvec4(solid), untold);
        border.whole = all(there);
        there = mix(inside, bvec4(!solid || from_behind), untold);
        vec4 rise = mix(vec4(NO_BORDER), at_corners(side * (vec2(slope.x, -slope.x) + slope.y)), there);
        border.rise = max(max(rise.x, rise.y), max(rise.z, rise.w));
    }
    return border;
}

#endif
