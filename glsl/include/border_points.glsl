// The border near a pixel, tested point by point. Needs trim.glsl.
#ifndef BORDER_POINTS_GLSL
#define BORDER_POINTS_GLSL

#include "border.glsl"
#include "gap_radius.glsl"

// One place in the code tests all points, since a wide machine runs every place for every pixel: first the point
// itself, then the circle or the point ahead.
Border border_at(FacePoint p, float reach, bool from_behind, vec2 ahead, vec2 slope) {
    Border border = Border(false, true, false, NO_BORDER);
    vec2 step_ = vec2(0.0);
    uint k = 0u;
    while (true) {
        bool is_in = trim_inside(p.fi, p.face, p.at + step_.x * p.dx + step_.y * p.dy);
        if (k == 0u) border.inside = is_in;
        else if (border.inside && from_behind) border.whole = border.whole && is_in;
        else if (border.inside) border.goes_on = is_in;
        else if (is_in) border.rise = max(border.rise, dot(step_, slope));
        bool around_it = from_behind || !border.inside;
        if (around_it ? reach == 0.0 || !border.whole || k == DIRECTION_COUNT : ahead == vec2(0.0) || k == 1u) break;
        step_ = around_it ? reach * DIRECTIONS[k] : ahead;
        ++k;
    }
    return border;
}

#endif
