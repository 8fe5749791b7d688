// The border near a pixel, by the u-intercept table: three scan lines replace the circle's eight points and decide what
// lies between them, too.
//
//          ┌─────┐      ┐ `across`: the scan line at its end, half as long
//        ╱         ╲    ┘
//      ╱      ·─────▶╲    the scan line of the point, within `along`, where only u changes
//      ╲             ╱
//        ╲         ╱
//          └─────┘        and one at the same distance on the other side
//
// The corners of gap_radius.glsl's hexagon are on the lines, turned so that the lines are scan lines.
//
// It always makes three look-ups, with one loop for all of their searches: on a wide machine a loop costs about as much
// as a look-up, whatever its number of rounds. For a steep front, the point ahead replaces one of the lines across
// before it is known whether the point is inside; such a front grows to one side only.
#ifndef BORDER_LINES_GLSL
#define BORDER_LINES_GLSL

#include "border.glsl"
#include "gap_radius.glsl"

// Some strip has several bins. A line is looked up within one bin.
layout(constant_id = 21) const bool TRIMS_HAVE_BINS = false;

uint told_along(FacePoint p, vec2 step_, float reach) {
    return table_along(p.fi.first_bin, p.face.strips, p.at + step_.x * p.dx + step_.y * p.dy, reach);
}

Search search_for(FacePoint p, vec2 step_) {
    return search_at(p.fi.first_bin, p.face.strips, p.at + step_.x * p.dx + step_.y * p.dy);
}

// The rise to the nearest inner point of a line, `aside` long to either side.
float rise_along(uint told, float at, float aside) {
    float rise = NO_BORDER;
    if ((told & (ALONG_INSIDE | ALONG_BEFORE)) != 0u) rise = at - aside;
    if ((told & (ALONG_INSIDE | ALONG_BEHIND)) != 0u) rise = max(rise, at + aside);
    return rise;
}

Border border_at(FacePoint p, float reach, bool from_behind, vec2 ahead, vec2 slope) {
    // the direction, in pixels, in which v changes most: across the scan lines
    vec2 upwards = vec2(p.dx.y, p.dy.y) / max(length(vec2(p.dx.y, p.dy.y)), 1e-30);
    vec2 across = APOTHEM * reach * upwards;
    vec2 along = CORNER * reach * vec2(upwards.y, -upwards.x);
    float width = along.x * p.dx.x + along.y * p.dy.x;
    if (width < 0.0) along = -along;
    width = abs(width);
    bool asks_ahead = !from_behind && ahead != vec2(0.0);
    vec2 one = asks_ahead ? ahead : across;
    Search at_point = search_for(p, vec2(0.0));
    Search at_one = search_for(p, one);
    Search at_other = search_for(p, -across);
    while (is_open(at_point) || is_open(at_one) || is_open(at_other)) {
        halve(at_point);
        halve(at_one);
        halve(at_other);
    }
    uint told = told_by(at_point, width);
    uint told_one = told_by(at_one, asks_ahead ? 0.0 : 0.5 * width);
    uint told_other = told_by(at_other, 0.5 * width);
    bool inside = (told & ALONG_INSIDE) != 0u;
    bool whole = told == ALONG_INSIDE && told_one == ALONG_INSIDE && told_other == ALONG_INSIDE;
    float aside = dot(along, slope);
    float up = dot(across, slope);
    float rise = rise_along(told, 0.0, aside);
    if (!asks_ahead) rise = max(rise, rise_along(told_one, up, 0.5 * aside));
    rise = max(rise, rise_along(told_other, -up, 0.5 * aside));
    if (TRIMS_HAVE_BINS) {
        // a line may end within the circle, whose points do not
        float wide = CORNER * reach * (abs(p.dx.x) + abs(p.dy.x));
        bool one_bin = table_one_bin(p.face.strips, p.at.x - wide, p.at.x + wide);
        for (uint k = 0u; k < DIRECTION_COUNT && !one_bin; ++k) {
            vec2 step_ = reach * DIRECTIONS[k];
            bool is_in = told_along(p, step_, 0.0) == ALONG_INSIDE;
            whole = whole && is_in;
            if (is_in) rise = max(rise, dot(step_, slope));
        }
    }
    bool looks_beside = reach > 0.0;
    return Border(inside, whole || !looks_beside, (told_one & ALONG_INSIDE) != 0u, looks_beside ? rise : NO_BORDER);
}

#endif
