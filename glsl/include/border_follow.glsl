// Pass `border_follow`: points of pixels at borders where a sheet's terms of second order do not reach (border_mix.glsl)
// follow the exact surface of each such sheet, and keep what is nearest. One thread a listed point, so no order of
// threads matters: sheets of one point are compared in the order in which they were found, and of equal depths the first
// stays.
//
//     pixel around that sees the face ──Newton's method, from patch to patch──▶ the point's ray: is the face there?
#include "scene.glsl"
#include "view.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 7, rg32ui) readonly uniform uimage2D visibility;
#include "border_pixel.glsl"
layout(scalar, binding = 8) readonly buffer List { BorderPixel list[]; };
#include "border_followed.glsl"
layout(scalar, binding = 9) buffer FollowedPoints { FollowedPoint followed_points[]; };
layout(scalar, binding = 10) readonly buffer FollowedLists { FollowedGrids followed; };

#define TRIM_BINDING 12
#include "trim.glsl"
#ifdef WITHIN_VOLUME
#define VOLUME_BINDING (TRIM_BINDING + TRIM_BUFFERS)
#include "volume.glsl"
#endif
#include "placed.glsl"
#include "patch.glsl"
#include "patch_place.glsl"
#define REFINE_DAMPED
#include "refine.glsl"
#include "visible.glsl"
#include "shade.glsl"
#include "face_point.glsl"

#include "border_around.glsl"
#include "border_reach.glsl"
// BORDER_POINTS a pixel of the list. Only scenes with meshes or Boolean solids have them.
layout(scalar, binding = 11) writeonly buffer SeenPoints { BorderPoint seen_points[]; };

// Whether the face is there at (u, v) of a patch, or where its surface goes on over a seam.
bool is_in_face(FaceInstance fi, Face face, uint patch_instance, Patch patch_, vec2 uv) {
    vec2 at = patch_.domain.xy + uv * patch_.domain.zw;
    vec2 there = over_seams(face.flags, at);
    if (there == at) return is_there(fi, face, patch_instance, patch_, uv);
    if (clamp(there, 0.0, 1.0) != there) return false;
    ivec2 count = ivec2(face.count_u, face.count_v);
    ivec2 way = mix(ivec2(0), way_beyond(uv, 0.0), notEqual(there, at));
    ivec2 place = (place_of(face, int(patch_instance - fi.first_patch_instance)) + way + count) % count;
    uint side = side_of(patch_at(patch_in(face, place)).shape);
    if ((face.flags & FACE_TRIMMED) == 0u || side != SIDE_BOUNDARY) return side != SIDE_OUTSIDE;
#ifdef TRIM_BY_TABLE
    if (!table_covers(fi.first_bin, face.strips, there)) return false;
#endif
    return trim_inside(fi, face, there);
}

// Whether sides of the face's surface are points, round which its other sides meet: a pole, a tip.
bool has_pole(uint flags, out int round_) {
    bool of_v = ((flags >> FACE_POINTS) & (BORDER_V0 | BORDER_V1)) != 0u;
    bool of_u = ((flags >> FACE_POINTS) & (BORDER_U0 | BORDER_U1)) != 0u;
    round_ = of_v ? 0 : 1; // the parameter that goes round
    return of_v && (flags & FACE_MEETS_U) != 0u || of_u && (flags & FACE_MEETS_V) != 0u;
}

// The place half a turn round the pole from (u, v) of a patch, roughly, and as far before the pole as (u, v) is beyond it.
void turn(FaceInstance fi, Face face, int round_, inout uint patch_instance, inout vec2 uv) {
    ivec2 count = ivec2(face.count_u, face.count_v);
    ivec2 place = place_of(face, int(patch_instance - fi.first_patch_instance));
    float turned = clamp(uv[round_], 0.0, 1.0) + 0.5 * float(count[round_] % 2);
    place[round_] = (place[round_] + count[round_] / 2 + int(turned)) % count[round_];
    uint number = patch_in(face, place);
    if (side_of(patch_at(number).shape) == SIDE_OUTSIDE) return; // such a patch has no control points
    float along = uv[1 - round_];
    uv[round_] = fract(turned);
    uv[1 - round_] = clamp(along > 1.0 ? 2.0 - along : abs(along), 0.0, 1.0);
    patch_instance = fi.first_patch_instance + number - face.first_patch;
}

// Depth of the exact surface at a point of the picture, followed from where a pixel sees the face; UNSEEN if it is not
// there. Beyond a pole a patch goes on without its face, which lies half a turn away, and a way of many steps round a pole
// may end at a fold: the surface is followed from half a turn away once more.
float exact_depth_at(ivec2 from, vec2 pixel) {
    uvec2 seen = imageLoad(visibility, from).xy;
    uint patch_instance = seen_patch_instance(seen.x);
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Face face = face_at(fi.face);
    View view = view_at(fi.instance);
    vec2 uv = unpack_uv(seen.y);
    Sample there;
    Patch patch_;
    uint found; // patch instance
    int round_;
    bool turns = has_pole(face.flags, round_);
    for (uint i = 0u; i < 2u; ++i) {
        there = refine_across(fi, face, view, patch_instance, uv, pixel);
        found = patch_instance;
        patch_ = patch_at(face.first_patch + found - fi.first_patch_instance);
        bool met = length(there.miss) <= ON_PIXEL_PX;
        bool ends = !turns || met && !is_over_pole(face.flags, patch_.domain.xy + there.uv * patch_.domain.zw);
        uv = there.uv;
        if (!ends) turn(fi, face, round_, patch_instance, uv);
        if (ends) break; // only here: see refine.glsl
    }
    bool is = there.q.w > 0.0 && length(there.miss) <= ON_PIXEL_PX;
    // a patch whose neighbour does not reach the point, since it folds before, may go on to it
    is = is && !goes_on(fi, face, found, there.uv);
    is = is && is_in_face(fi, face, found, patch_, there.uv);
#ifdef WITHIN_VOLUME
    is = is && in_volume(there.q, ON_PX);
#endif
    return is ? there.q.z : UNSEEN;
}

void main() {
    uint thread = thread_number();
    if (thread >= followed.point_count) return;
    FollowedPoint point = followed_points[thread];
    uint i = point.point % BORDER_POINTS;
    BorderPixel border = list[point.point / BORDER_POINTS];
    ivec2 at = pixel_of(border);
    float depth = point.depth;
    uint shown = point.sheets >> FOLLOWED_SHOWN;
    for (uint left = point.sheets & ((1u << FOLLOWED_SHOWN) - 1u); left != 0u; left >>= 4u) {
        uint from = (left & 15u) - 1u;
        float there = exact_depth_at(around_or_far(at, from, border.sliver), vec2(at) + 0.5 + point_of(i));
        bool nearer = there < depth;
        if (nearer) depth = there;
        if (nearer) shown = from;
    }
    if (SCENE_HAS_MESHES_OR_SOLIDS) seen_points[point.point] = BorderPoint(depth, shown);
    else followed_points[thread].sheets = shown << FOLLOWED_SHOWN;
}
