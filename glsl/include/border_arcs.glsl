// The border near a pixel, by the exact arcs: the point and the corners of a square around it are told by the list of the
// point's cell, as far as they are in the list's box; those that are not, and the point ahead, by lists of their own.
//
//      1 ●─────────● 0      a straight border that comes nearer than the sides has a corner beyond it (SQUARE, ring.glsl)
//        │         │
//        │    ·──▶ │        each arc that is fetched is asked about all of them: where a point is in its triangle is
//        │         │        linear, and opposite corners are as far from the point
//      2 ●─────────● 3
#ifndef BORDER_ARCS_GLSL
#define BORDER_ARCS_GLSL

#include "border.glsl"
#include "ring.glsl"

// Bits of what is asked for: the corners, from the lowest one on, the point, and the one ahead.
const uint CORNERS = 15u;
const uint THE_POINT = 16u;
const uint AHEAD = 32u;

// Of a number at corners 0 and 1, less that at the point: the same at all corners.
vec4 at_corners(vec2 two) { return vec4(two, -two); }

uint bits_of(bvec4 b) {
    uvec4 bits = uvec4(b) << uvec4(0u, 1u, 2u, 3u);
    return bits.x | bits.y | bits.z | bits.w;
}

// What an arc adds to the winding numbers of the corners, whose v are `v`; how far in u and v those are from the point. As
// arc_winding, but for rounding.
ivec4 corner_windings(ExactArc arc, vec2 point, vec4 v, vec2 far_u, vec2 far_v) {
    ArcSides sides = arc_sides(arc);
    vec3 place = arc_place_of(arc, sides, point);
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
    vec2 point = p.at; // or the one ahead
    uint open = THE_POINT | (reach > 0.0 ? CORNERS : 0u); // what is still asked for
    uint inside = 0u;
    vec2 next = point;
    while (open != 0u) {
        ExactList list = exact_list(p.fi.face, next);
        int winding = list.winding;
        ivec4 windings = ivec4(list.winding);
        bool more = true;
        for (uint i = list.first; more; ++i) {
            ExactArc arc = exact_arc_at(i);
            winding += arc_winding(arc, point.y, arc_right(arc, point));
            windings += corner_windings(arc, p.at, v, far_u, far_v);
            more = (arc.shape & ARC_LAST) == 0u;
        }
        // the one whose list it is, whatever the rounding of its cell
        uint told = (open & THE_POINT) != 0u ? THE_POINT : open & (~open + 1u);
        vec2 lo = list.lo - list.margin;
        vec2 hi = list.hi + list.margin;
        told |= bits_of(lessThanEqual(max(max(lo.x - u, u - hi.x), max(lo.y - v, v - hi.y)), vec4(0.0)));
        uint found = bits_of(notEqual(windings, ivec4(0))) | (winding != 0 ? THE_POINT | AHEAD : 0u);
        inside |= found & told & open;
        // inside and from the front the corners are not asked for; the point ahead is, in the place of the point
        bool asks_ahead = (open & inside & THE_POINT) != 0u && !from_behind;
        open = asks_ahead ? (ahead != vec2(0.0) ? AHEAD : 0u) : open & ~told;
        if (asks_ahead) point = p.at + ahead.x * p.dx + ahead.y * p.dy;
        next = point;
        if ((open & 8u) != 0u) next = vec2(u.w, v.w);
        if ((open & 4u) != 0u) next = vec2(u.z, v.z);
        if ((open & 2u) != 0u) next = vec2(u.y, v.y);
        if ((open & 1u) != 0u) next = vec2(u.x, v.x);
    }
    Border border = Border((inside & THE_POINT) != 0u, true, (inside & AHEAD) != 0u, NO_BORDER);
    if (reach > 0.0) {
        border.whole = (inside & CORNERS) == CORNERS;
        vec2 rise = side * (vec2(slope.x, -slope.x) + slope.y);
        if ((inside & 1u) != 0u) border.rise = max(border.rise, rise.x);
        if ((inside & 2u) != 0u) border.rise = max(border.rise, rise.y);
        if ((inside & 4u) != 0u) border.rise = max(border.rise, -rise.x);
        if ((inside & 8u) != 0u) border.rise = max(border.rise, -rise.y);
    }
    return border;
}

#endif
