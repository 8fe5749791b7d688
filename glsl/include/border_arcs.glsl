// The border near a pixel, by the exact arcs: the point and the corners of a hexagon around it are told by the list of the
// point's cell, as far as they are in the list's box; those that are not, and the point ahead, by lists of their own.
//
//          ●───────●          a straight border that has one of the ring's eight points beyond it has one of
//        ╱           ╲        these beyond it, too (HEXAGON, ring.glsl)
//       ●      ·──▶   ●
//        ╲           ╱        each arc that is fetched is asked about all of them: fetches are what costs
//          ●───────●
#ifndef BORDER_ARCS_GLSL
#define BORDER_ARCS_GLSL

#include "border.glsl"
#include "ring.glsl"

const uint ASKED = HEXAGON_CORNERS + 1u; // the point, and the corners
const uint THE_POINT = 1u;
const uint CORNERS = ((1u << HEXAGON_CORNERS) - 1u) << 1u;
const uint AHEAD = 1u << ASKED;

Border border_at(FacePoint p, float reach, bool from_behind, vec2 ahead, vec2 slope) {
    vec2 steps[ASKED];
    vec2 at[ASKED];
    for (uint k = 0u; k < ASKED; ++k) {
        steps[k] = k == 0u ? vec2(0.0) : reach * HEXAGON[k - 1u];
        at[k] = p.at + steps[k].x * p.dx + steps[k].y * p.dy;
    }
    uint open = THE_POINT | (reach > 0.0 ? CORNERS : 0u); // what is still asked for
    uint inside = 0u;
    vec2 next = p.at;
    while (open != 0u) {
        ExactList list = exact_list(p.fi.face, next);
        int winding[ASKED];
        for (uint k = 0u; k < ASKED; ++k) winding[k] = list.winding;
        bool more = true;
        for (uint i = list.first; more; ++i) {
            ExactArc arc = exact_arc_at(i);
            for (uint k = 0u; k < ASKED; ++k) winding[k] += arc_winding(arc, at[k]);
            more = (arc.shape & ARC_LAST) == 0u;
        }
        uint told = open & (~open + 1u); // the next one, whatever the rounding of its cell
        uint found = 0u;
        for (uint k = 0u; k < ASKED; ++k) {
            told |= holds_for(list, at[k]) ? 1u << k : 0u;
            found |= winding[k] != 0 ? 1u << k : 0u;
        }
        if (open == AHEAD) found = winding[0] != 0 ? AHEAD : 0u;
        inside |= found & told & open;
        // inside and from the front the corners are not asked for; the point ahead is, in the place of the point
        bool asks_ahead = (open & inside & THE_POINT) != 0u && !from_behind;
        open = asks_ahead ? (ahead != vec2(0.0) ? AHEAD : 0u) : open & ~told;
        if (asks_ahead) at[0] = p.at + ahead.x * p.dx + ahead.y * p.dy;
        next = at[0];
        for (uint k = ASKED - 1u; k > 0u; --k) {
            if ((open & 1u << k) != 0u) next = at[k];
        }
    }
    Border border = Border((inside & THE_POINT) != 0u, true, (inside & AHEAD) != 0u, NO_BORDER);
    if (reach > 0.0) {
        border.whole = (inside & CORNERS) == CORNERS;
        for (uint k = 1u; k <= HEXAGON_CORNERS; ++k) {
            if ((inside & 1u << k) != 0u) border.rise = max(border.rise, dot(steps[k], slope));
        }
    }
    return border;
}

#endif
