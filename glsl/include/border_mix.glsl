// Pass `border_mix`: mixes pixels at borders from the colours around them. In scenes with meshes or Boolean solids it
// evaluates the patches only, and pass `border_mean` mixes. One thread for each pixel of the list.
//
//     ┌────────────┐    sixteen points of the pixel, each in a row and a column of its own. At each point, the sheets
//     │·  A  ╲     │    visible in the nine pixels around are evaluated, with their trims; the nearest is visible. If
//     │    ·  ╲  B │    there is none, the point shows the nearest of these pixels without a patch.
//     │  ·     ╲  ·│
//     └────────────┘    a sheet has the colour of the pixel that shows it
//
// A sheet is one side of a face as it is seen: a face that hides a part of itself has several. The pass
// evaluates its exact surface three times, at the middle near the pixel's centre and beside it. The points are met by
// Newton's method on its terms of second order, which also bend at a fold:
//
//     q(u, v) ≈ q + u qu + v qv + (u² quu + 2 u v quv + v² qvv) / 2      homogeneous pixels, from the middle on
//
// A plane is exact. Where the terms do not reach (border_reach.glsl), near a pole, a tip, or on a sheet that is seen
// nearly edge-on, the point is listed (border_followed.glsl): pass `border_follow` follows the exact surface, from the
// nearest other pixel that sees the face, and the pixel is mixed after it. Beyond a pole or a tip the surface is not the
// one that goes on from the sheet's own pixel. The trim test is that of one way (trim.glsl).
#include "scene.glsl"
#include "view.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 7, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 8, rgba32f) readonly uniform image2D resolved; // linear colour, depth; UNSEEN for background
#include "border_pixel.glsl"
layout(scalar, binding = 9) buffer List { BorderPixel list[]; };
layout(scalar, binding = 10) readonly buffer Grids { BorderGrids grids; };
#include "border_followed.glsl"
layout(scalar, binding = 12) writeonly buffer FollowedPoints { FollowedPoint followed_points[]; };
layout(scalar, binding = 13) writeonly buffer FollowedPixels { FollowedPixel followed_pixels[]; };
layout(scalar, binding = 14) buffer FollowedLists { FollowedGrids followed; }; // zero before
layout(scalar, binding = 15) buffer CountersBuffer { Counters counters; };
layout(scalar, push_constant) uniform Push { uint capacity; }; // points that followed_points has room for

#define TRIM_BINDING 16
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
#include "unmixed.glsl"
#include "grid.glsl"

#include "border_seen.glsl"
#include "border_reach.glsl"
#include "border_sliver.glsl"
// BORDER_POINTS a pixel of the list. Only scenes with meshes or Boolean solids have them.
layout(scalar, binding = 11) writeonly buffer SeenPoints { BorderPoint seen_points[]; };

// Some point of some face may be listed (src/scene/face.rs).
layout(constant_id = 37) const bool FACES_ARE_FOLLOWED = false;

// Two words keep BORDER_POINTS bits a sheet, and a listed point has four bits a sheet.
const uint MOST_SHEETS = 4u;
// Required distance of a sheet's middle to the pixel's centre, in pixels: far less than a sixteenth.
const float CLOSE_PX = 0.02;
// Two are enough, but for what is narrower than a pixel (steps are at most MAX_STEP) and beside folds, where each step
// leaves a quarter of the distance.
const uint POINT_STEPS = 8u;
// Distance from a point at which the steps end: the rounding of a place in a picture 2000 pixels wide.
const float POINT_MET_PX = 1.0 / 4096.0;

// A sheet near the pixel's centre.
struct Sheet {
    uint patch_instance;
    FaceInstance fi;
    Face face;
    Patch patch_;
    vec2 middle; // (u, v) of the point nearest to the pixel's centre
    vec2 seen;   // where the sheet is visible, from the middle
    vec4 q;      // homogeneous pixel of the middle, and its derivatives
    vec4 qu;
    vec4 qv;
    vec4 quu;
    vec4 quv;
    vec4 qvv;
    vec3 third; // of what these leave out
};

// The sheet that is visible in the pixel `at`, near another pixel's centre.
Sheet sheet_at(ivec2 at, vec2 centre) {
    uvec2 seen = imageLoad(visibility, at).xy;
    Sheet s;
    s.patch_instance = seen_patch_instance(seen.x);
    s.fi = face_instance_at(face_instance_of(s.patch_instance));
    s.face = face_at(s.fi.face);
    s.patch_ = patch_at(s.face.first_patch + s.patch_instance - s.fi.first_patch_instance);
    View view = view_at(s.fi.instance);
    Sample middle = refine_to(s.patch_, view, unpack_uv(seen.y), centre, CLOSE_PX);
    s.middle = middle.uv;
    s.seen = unpack_uv(seen.y) - middle.uv;
    s.q = middle.q;
    s.qu = to_pixel(view, vec4(middle.jet.du, 0.0));
    s.qv = to_pixel(view, vec4(middle.jet.dv, 0.0));
    Net net = net_of(s.patch_);
    vec4 du[2];
    vec4 dv[2];
    vec4 ends[2];
    for (uint k = 0u; k < 2u; ++k) {
        vec2 step_ = k == 0u ? vec2(ASIDE, 0.0) : vec2(0.0, ASIDE);
        Sample beside = sample_at(s.patch_, net, view, s.middle + step_, centre);
        du[k] = (to_pixel(view, vec4(beside.jet.du, 0.0)) - s.qu) / ASIDE;
        dv[k] = (to_pixel(view, vec4(beside.jet.dv, 0.0)) - s.qv) / ASIDE;
        // the mean of the derivatives at both ends
        vec4 run = k == 0u ? s.qu + 0.5 * ASIDE * du[0] : s.qv + 0.5 * ASIDE * dv[1];
        ends[k] = to_pixel(view, vec4(beside.jet.point - middle.jet.point, 0.0)) - ASIDE * run;
    }
    s.quu = du[0];
    s.quv = 0.5 * (dv[0] + du[1]);
    s.qvv = dv[1];
    bool plane = s.patch_.bend == vec3(0.0);
    s.third = plane ? vec3(0.0) : third_order(s.q, ends[0], ends[1], dv[0] - du[1]);
    return s;
}

// Depth of a sheet at a point of the picture; UNSEEN if it is not there. `is_open`: its terms do not tell.
float depth_at(Sheet s, vec2 pixel, out bool is_open) {
    vec2 uv = s.seen;
    vec2 nearest = uv;
    float least = UNSEEN;
    vec2 miss;
    vec4 q;
    for (uint i = 0u; i < POINT_STEPS; ++i) {
        vec4 qu = s.qu + uv.x * s.quu + uv.y * s.quv;
        vec4 qv = s.qv + uv.x * s.quv + uv.y * s.qvv;
        q = s.q + 0.5 * (uv.x * (s.qu + qu) + uv.y * (s.qv + qv));
        miss = q.xy / q.w - pixel;
        bool nearer = dot(miss, miss) < least;
        if (nearer) nearest = uv;
        if (nearer) least = dot(miss, miss);
        bool met = least <= POINT_MET_PX * POINT_MET_PX;
        vec2 step_;
        if (newton_step(pixels_along(q, qu, qv), miss, s.patch_, step_) && !met) uv -= step_;
        if (met) break; // only here: see refine.glsl
    }
    // a paraboloid also meets the ray behind the eye
    bool meets = q.w > 0.0 && length(miss) <= ON_PIXEL_PX;
    vec2 way = meets ? uv : nearest;
    vec2 of_face = s.patch_.domain.xy + (s.middle + way) * s.patch_.domain.zw;
    vec2 there = over_seams(s.face.flags, of_face);
    // beyond the ends of its domain the face is not there, whatever surface goes on
    bool has_left = clamp(there, 0.0, 1.0) != there;
    bool holds = has_left ? remainder_px(s.third, way) <= REMAINDER_PX : is_in_reach(s.third, s.middle, way);
    // the terms may meet no ray beyond a pole that the face, half a turn away, meets
    is_open = !holds || is_over_pole(s.face.flags, of_face) || meets && there != of_face;
    bool is = meets && !is_open && is_there(s.fi, s.face, s.patch_instance, s.patch_, s.middle + uv);
#ifdef WITHIN_VOLUME
    is = is && in_volume(q, ON_PX);
#endif
    return is ? q.z : UNSEEN;
}

// Lists `count` points to follow; the place of the first of them. `has_room`: all of them have a place.
uint follow(uint count, out bool has_room) {
    uint first = atomicAdd(followed.wanted, count);
    uint end = first + count;
    has_room = end <= capacity;
    atomicMax(counters.followed_points, end);
    if (!has_room) atomicOr(counters.failed, FAILED_FOLLOWED_POINTS);
    uint point_end = min(end, capacity);
    atomicMax(followed.point_count, point_end);
    uvec3 points_ = grid_of((point_end + FOLLOWED_GROUP - 1u) / FOLLOWED_GROUP);
    for (uint axis = 0u; axis < 3u; ++axis) atomicMax(followed.points[axis], points_[axis]);
    return first;
}

// Lists a pixel whose mean waits for them.
void mix_later(FollowedPixel pixel) {
    uint at = atomicAdd(followed.pixel_count, 1u);
    followed_pixels[at] = pixel;
    uvec3 pixels = grid_of(at / FOLLOWED_GROUP + 1u);
    for (uint axis = 0u; axis < 3u; ++axis) atomicMax(followed.pixels[axis], pixels[axis]);
}

// Whether a face's depth jumps between the pixel, whose depth is `own`, and a pixel around: by more than to the pixel on
// the other side. `ahead` and `back` are the depths of these two less `own`.
bool jumps_to(float ahead, float back, float own) { return abs(ahead) >= abs(back) && jumps(back, ahead, own); }

// Whether what two pixels around see of a face is so far apart in depth that it may be two sheets: a steep sheet is
// evaluated twice.
bool are_apart(uint a, uint b, float depth_a, float depth_b) {
    float px = (frame.perspective != 0u ? depth_a : 1.0) / frame.focal;
    ivec2 way = around(ivec2(0), a) - around(ivec2(0), b);
    return abs(depth_a - depth_b) > JUMP_PX * px * length(vec2(way));
}

void main() {
    uint n = thread_number();
    if (n >= grids.count) return;
    ivec2 at = pixel_of(list[n]);
    uvec2 own = imageLoad(visibility, at).xy;
    bool own_patch = !sees_nothing(own.x) && !sees_other(own.x);
    float own_depth = imageLoad(resolved, at).a;
    float depths[BORDER_POINTS];
    uint shown[BORDER_POINTS]; // a pixel around
    for (uint k = 0u; k < BORDER_POINTS; ++k) {
        depths[k] = UNSEEN;
        shown[k] = NOBODY;
    }
    uint no_patch = 0u; // bits of pixels around
    uint met[MOST_SHEETS]; // face, and pixel around
    uint met_from[MOST_SHEETS];
    uint met_count = 0u;
    uint placed[AROUND]; // the placed face of each pixel around, from 1 on
    float depths_around[AROUND]; // of pixels beside the picture the own one
    for (uint n = 0u; n < AROUND; ++n) {
        ivec2 beside = around(at, n);
        placed[n] = 0u;
        depths_around[n] = is_in_picture(beside) ? imageLoad(resolved, beside).a : own_depth;
    }
    for (uint k = 0u; k < AROUND; ++k) {
        uint from = (k + OWN) % AROUND; // the pixel itself first
        ivec2 beside = around(at, from);
        if (!is_in_picture(beside)) continue;
        uint seen = imageLoad(visibility, beside).x;
        if (sees_nothing(seen) || sees_other(seen)) {
            no_patch |= 1u << from;
            continue;
        }
        uint face = face_instance_of(seen_patch_instance(seen)) << 1;
        placed[from] = (face >> 1) + 1u;
        // a second sheet of the pixel's own face
        uint opposite = AROUND - 1u - from;
        bool jump = jumps_to(depths_around[from] - own_depth, depths_around[opposite] - own_depth, own_depth);
        if (own_patch && k > 0u && face == met[0] && jump) face |= 1u;
        bool known = met_count == MOST_SHEETS;
        for (uint i = 0u; i < met_count; ++i) known = known || met[i] == face;
        if (known) continue;
        met[met_count] = face;
        met_from[met_count++] = from;
    }
    uint sliver = NO_SLIVER;
    if (met_count > 0u && met_count < MOST_SHEETS) sliver = sliver_along(at, placed);
    if (sliver != NO_SLIVER) {
        list[n].sliver = sliver;
        met[met_count] = (placed_face_at(around_or_far(at, SLIVER, sliver)) - 1u) << 1;
        met_from[met_count++] = SLIVER;
    }
    // A second sheet of a face that the pixel does not see, as in a notch between a fold and a border. It comes last: of
    // steep faces it is the first one once more.
    for (uint n = 0u; n < AROUND && met_count < MOST_SHEETS; ++n) {
        if (placed[n] == 0u || placed[n] == placed[OWN]) continue;
        uint face = (placed[n] - 1u) << 1;
        uint first = n; // sees the first sheet
        bool known = false;
        for (uint i = 0u; i < met_count; ++i) {
            if (met[i] == face && met_from[i] != SLIVER) first = met_from[i];
            known = known || met[i] == (face | 1u);
        }
        if (known || !are_apart(n, first, depths_around[n], depths_around[first])) continue;
        met[met_count] = face | 1u;
        met_from[met_count++] = n;
    }
    uvec2 open = uvec2(0u); // bits of points, of two sheets a word
    // a separate loop: threads that run together find their sheets at different pixels
    for (uint n = 0u; n < met_count; ++n) {
        Sheet s = sheet_at(around_or_far(at, met_from[n], sliver), vec2(at) + 0.5);
        for (uint i = 0u; i < BORDER_POINTS; ++i) {
            bool is_open;
            float depth = depth_at(s, vec2(at) + 0.5 + point_of(i), is_open);
            if (is_open) open[n / 2u] |= 1u << (i + BORDER_POINTS * (n % 2u));
            if (!(depth < depths[i])) continue;
            depths[i] = depth;
            shown[i] = met_from[n];
        }
    }
    uint points_left = 0u; // bits of points that some sheet leaves open
    if (FACES_ARE_FOLLOWED) points_left = bitfieldExtract((open.x | open.y) | (open.x | open.y) >> 16, 0, 16);
    uint first_left = 0u;
    bool has_room = false;
    if (points_left != 0u) first_left = follow(uint(bitCount(points_left)), has_room);
    uint place = first_left;
    for (uint left = points_left; left != 0u; left &= left - 1u) {
        uint i = uint(findLSB(left));
        uint sheets = 0u;
        uint sheet_count = 0u;
        for (uint n = 0u; n < met_count; ++n) {
            if ((open[n / 2u] >> (i + BORDER_POINTS * (n % 2u)) & 1u) == 0u) continue;
            // from another pixel: beyond a pole or a tip the surface is not the one that goes on from here
            uint others = 0u;
            for (uint k = 0u; k < AROUND; ++k) {
                if (k != met_from[n] && placed[k] == (met[n] >> 1) + 1u) others |= 1u << k;
            }
            uint from = nearest_of(others, point_of(i));
            if (from == NOBODY) from = met_from[n];
            sheets |= (from + 1u) << (4u * sheet_count++);
        }
        sheets |= shown[i] << FOLLOWED_SHOWN;
        // where the pixel's points have no room together, the frame is drawn again
        if (place < capacity) followed_points[place] = FollowedPoint(n * BORDER_POINTS + i, sheets, depths[i]);
        ++place;
    }
    if (SCENE_HAS_MESHES_OR_SOLIDS) {
        uint first = n * BORDER_POINTS;
        for (uint k = 0u; k < BORDER_POINTS; ++k) seen_points[first + k] = BorderPoint(depths[k], shown[k]);
        return;
    }
    if (has_room) {
        mix_later(FollowedPixel(n, first_left, points_left | no_patch << BORDER_POINTS));
        uvec2 all = uvec2(0u);
        for (uint k = 0u; k < BORDER_POINTS; ++k) all[k / 8u] |= shown[k] << (4u * (k % 8u));
        list[n].mean = all;
        return;
    }
    vec4 sum = vec4(0.0);
    for (uint k = 0u; k < BORDER_POINTS; ++k) sum += shown_at(at, k, shown[k], no_patch, sliver);
    list[n].mean = packed_mean(sum);
}
