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
#include "refine.glsl"
#include "visible.glsl"
#include "shade.glsl"
#include "face_point.glsl"

#include "border_around.glsl"
#include "border_reach.glsl"
// BORDER_POINTS a pixel of the list: where others than patches are asked, too
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

// Depth of the exact surface at a point of the picture, followed from where a pixel sees the face; UNSEEN if it is not
// there.
float exact_depth_at(ivec2 from, vec2 pixel) {
    uvec2 seen = imageLoad(visibility, from).xy;
    uint patch_instance = seen_patch_instance(seen.x);
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Face face = face_at(fi.face);
    Sample there = refine_across(fi, face, view_at(fi.instance), patch_instance, unpack_uv(seen.y), pixel);
    Patch patch_ = patch_at(face.first_patch + patch_instance - fi.first_patch_instance);
    bool is = there.q.w > 0.0 && length(there.miss) <= ON_PIXEL_PX;
    is = is && is_in_face(fi, face, patch_instance, patch_, there.uv);
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
    ivec2 at = pixel_of(list[point.point / BORDER_POINTS]);
    float depth = point.depth;
    uint shown = point.sheets >> FOLLOWED_SHOWN;
    for (uint left = point.sheets & ((1u << FOLLOWED_SHOWN) - 1u); left != 0u; left >>= 4u) {
        uint from = (left & 15u) - 1u;
        float there = exact_depth_at(around(at, from), vec2(at) + 0.5 + point_of(i));
        bool nearer = there < depth;
        if (nearer) depth = there;
        if (nearer) shown = from;
    }
    if (SCENE_HAS_MESHES_OR_SOLIDS) seen_points[point.point] = BorderPoint(depth, shown);
    else followed_points[thread].sheets = shown << FOLLOWED_SHOWN;
}
