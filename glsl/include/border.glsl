// What a trimmed face is at a pixel's centre and in the circle around it: what the trim test is asked, and what it tells.
// border_points.glsl asks any test, point by point; border_lines.glsl one that knows the borders along v = const;
// border_arcs.glsl one that has the arcs near a point. All define
//
//   Border border_at(FacePoint p, float reach, bool from_behind, vec2 ahead, vec2 slope)
//
//     reach        radius of the circle, pixels; 0: only the point is asked for
//     from_behind  the circle around a point inside the face is asked for as well as that around one outside
//     ahead        pixels; else a point there is asked for where the point is inside, unless it is zero
//     slope        of the depth, a pixel to the right and down
#ifndef BORDER_GLSL
#define BORDER_GLSL

// Where a fragment is in (u, v) of its face, and how that changes a pixel to the right and down.
struct FacePoint {
    FaceInstance fi;
    Face face;
    vec2 at;
    vec2 dx;
    vec2 dy;
};

struct Border {
    bool inside;  // the point
    bool whole;   // a point inside, from behind: so is all of its circle
    bool goes_on; // a point inside: so is the one ahead
    float rise;   // a point outside: depth of the circle's nearest point that is inside, less that of the point; or NO_BORDER
};

const float NO_BORDER = -3.0e38;

#endif
