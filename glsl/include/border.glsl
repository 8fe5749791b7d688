// A trimmed face at a pixel's centre and in the circle around it: input and result of the trim test. border_points.glsl
// evaluates any test point by point; border_lines.glsl uses a test that knows the borders along v = const;
// border_arcs.glsl uses a list of the arcs near a point. All define
//
//   Border border_at(FacePoint p, float reach, bool from_behind, vec2 ahead, vec2 slope)
//
//     reach        radius of the circle, pixels; 0: only the point is tested
//     from_behind  the circle is tested around a point inside the face, too, not only around a point outside
//     ahead        pixels; otherwise, for a point inside, the point there is tested, unless this is zero
//     slope        of the depth, a pixel to the right and down
#ifndef BORDER_GLSL
#define BORDER_GLSL

// A fragment's place in (u, v) of its face, and its change a pixel to the right and down.
struct FacePoint {
    FaceInstance fi;
    Face face;
    vec2 at;
    vec2 dx;
    vec2 dy;
};

struct Border {
    bool inside;  // the point is inside
    bool whole;   // for a point inside, from behind: all of its circle is inside
    bool goes_on; // for a point inside: the point ahead is inside, too
    float rise;   // for a point outside: depth of the circle's nearest inner point, less that of the point; or NO_BORDER
};

const float NO_BORDER = -3.0e38;

#endif
