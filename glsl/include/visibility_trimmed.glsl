// Pass `visibility`, trimmed patches: like visibility.frag, with the trim test of one way (trim.glsl).
//
// Two faces that meet along an edge are trimmed separately, each with its own rounding, and a pixel in the gap between
// them would show a surface behind. Such pixels are marked as gap candidates, and pass `gap_fill` decides them:
//
// * A solid's face that shows its back, if the whole circle of gap_radius_px around the pixel's centre is inside its
//   trims: the pixel shows the solid's inside through the gap. The back wins over a touching face of another solid.
// * The skirt around a solid's face that shows its back, on either side of the border: faces behind then leave no gap
//   of their own, and the far end of a hole, drawn narrower than it is, does not hide the hole's wall.
// * The skirt around each face of an open shell. Within the border the face is drawn, and marked: the face before it
//   may end in a silhouette, which is drawn narrower than it is. An open shell has no known front.
//
// Skirts are not drawn, because a surface behind them may be correct. Each pixel stores only the nearest depth of its
// skirts.
//
// If a volume trims the scene (WITHIN_VOLUME), the exact point at (u, v) must be within it, also for skirts.
//
// The skirt of an open shell has the depth of the border that it continues, not that of the continued surface: a floor
// seen from a low angle must neither cover an object in front of its edge, nor be lost behind another face that ends
// there and continues before it.
#include "scene.glsl"
#include "view.glsl"
#define INSTANCES_BINDING 9
#include "placed.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 10, r32ui) uniform uimage2D border_depths; // depth's bits, 0 without a skirt

#define TRIM_BINDING 11
#include "trim.glsl"
#ifdef WITHIN_VOLUME
#define VOLUME_BINDING (TRIM_BINDING + TRIM_BUFFERS)
#include "exact_point.glsl"
#endif
#include "facing.glsl"
#ifdef TRIM_BY_TABLE
#include "border_lines.glsl"
#elif defined(TRIM_BY_EXACT)
#include "border_arcs.glsl"
#else
#include "border_points.glsl"
#endif
#include "visible.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint patch_instance;
layout(location = 0) out uvec2 visible;
layout(depth_less) out float gl_FragDepth;

// A solid's faces that face the viewer grow by this share of the gap radius, which closes most gaps at once. They grow
// only as far as their surface follows the triangle: a surface nearly parallel to the rays does not.
const float GROWTH = 0.25;
// Where two solids touch, the back of one must win over the front of the other. Each is drawn up to deviation_px off,
// so the front is moved back by twice that in space, and at least by the rounding of interpolated depth. A wall nearly
// parallel to the rays would then lie behind the surface that it hides. If such a wall continues towards the viewer by
// more than its border's deviation, and bends less than that, it is moved back only by that deviation and by the grid
// of SNAP_PX on which devices place vertices. A face that has grown is not nearer than its border.
const float STAND_BACK = 2e-6;
const float SNAP_PX = 1.0 / 256.0;
const float STEEP = 4.0; // pixels of depth a pixel

// Distance between the surface and its tangent plane within such a step in (u, v) of the patch, in model units.
float bend_within(Patch patch_, vec2 far) {
    return 0.5 * dot(patch_.bend, vec3(far.x * far.x, 2.0 * far.x * far.y, far.y * far.y));
}

void main() {
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Face face = face_at(fi.face);
    Patch patch_ = patch_at(face.first_patch + patch_instance - fi.first_patch_instance);
    vec2 at = patch_.domain.xy + uv * patch_.domain.zw;
    vec2 dx = dFdx(uv) * patch_.domain.zw;
    vec2 dy = dFdy(uv) * patch_.domain.zw;
    vec2 slope = vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z));
    bool away = looks_away(dx, dy, face, instance_at(fi.instance));
    bool solid = (face.flags & FACE_SOLID) != 0u;
    bool candidate = solid && away;
    float reach = solid && !away ? GROWTH * frame.gap_radius_px : frame.gap_radius_px;
    vec2 around = reach * (abs(dx) + abs(dy)); // the point's circle is in this box
#ifdef TRIM_BY_TABLE
    uint area = TRIM_MIXED; // three scan lines are always looked up, which costs less than classifying the area
#else
    uint area = trim_area(fi, face, at - around, at + around);
#endif
    if (area == TRIM_OUT) discard;
    bool grows = area == TRIM_MIXED;
    float px = frame.focal * (frame.perspective != 0u ? gl_FragCoord.w : 1.0) * instance_at(fi.instance).scale;
    // depth per unit along the view axis, times the size of a pixel there
    float range = frame.far - frame.near;
    float unit = frame.perspective != 0u ? frame.near * frame.far * gl_FragCoord.w / range : 1.0 / range;
    float off = 2.0 * frame.deviation_px;
    bool steep = false;
    if (solid && !away) {
        vec2 far = around / patch_.domain.zw; // the circle's extent in (u, v) of the patch
        grows = grows && bend_within(patch_, far) * px <= (GAP_SLACK - 1.0) * reach + 2.0 * frame.deviation_px;
        steep = length(slope) > STEEP * unit / frame.focal;
    }
    vec2 ahead = steep ? off * normalize(slope) : vec2(0.0);
    Border border = border_at(FacePoint(fi, face, at, dx, dy), grows ? reach : 0.0, away, ahead, slope);
    bool inside = area == TRIM_IN || border.inside;
    bool whole = solid && !away || border.whole;
    bool goes_on = border.goes_on;
    // the nearest of the circle's points inside the face
    float border_depth = border.rise == NO_BORDER ? -1.0 : max(gl_FragCoord.z + border.rise, 0.0);
    if (!inside && border_depth < 0.0) discard;
    bool skirt = !inside && (candidate || !solid) || candidate && !whole;
#ifdef WITHIN_VOLUME
    // a gap between faces may run along the volume's boundary: skirts reach beyond it
    if (!in_volume(exact_point(patch_, view_at(fi.instance), uv), inside && !skirt ? ON_PX : frame.gap_radius_px)) discard;
#endif
    float z = gl_FragCoord.z;
    if (!inside && !candidate) z = solid ? min(z, border_depth) : border_depth;
    float stand_back = 0.0;
    if (solid && !away) {
        if (inside && steep && goes_on) off = min(off, 2.0 * (bend_within(patch_, vec2(1.0)) * px + SNAP_PX));
        stand_back = off * (abs(slope.x) + abs(slope.y) + unit / frame.focal) + STAND_BACK * z;
    }
    // depths are not negative, so they order like their bits
    uint skirt_depth = floatBitsToUint(max(z - stand_back, 0.0));
    if (skirt || !whole) {
        imageAtomicMax(border_depths, ivec2(gl_FragCoord.xy), skirt ? skirt_depth : skirt_depth + 1u);
    }
    if (skirt) discard;
    visible = uvec2(patch_instance + 1u | (candidate ? GAP_CANDIDATE : 0u), pack_uv(uv));
    gl_FragDepth = z - stand_back;
}
