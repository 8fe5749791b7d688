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
// A plane is exact. The trim test is that of one way (trim.glsl).
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
#include "unmixed.glsl"

#include "border_seen.glsl"
// BORDER_POINTS a pixel of the list: where others than patches are asked, too
layout(scalar, binding = 11) writeonly buffer SeenPoints { BorderPoint seen_points[]; };

const uint MOST_SHEETS = 4u;
// Required distance of a sheet's middle to the pixel's centre, in pixels: far less than a sixteenth.
const float CLOSE_PX = 0.02;
// From the middle to where the derivatives are taken again, of the patch: its second derivatives are differences.
const float ASIDE = 1.0 / 64.0;
// Two are enough, but for what is narrower than a pixel (steps are at most MAX_STEP) and beside folds, where each step
// leaves a quarter of the distance.
const uint POINT_STEPS = 8u;

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
    for (uint k = 0u; k < 2u; ++k) {
        vec2 step_ = k == 0u ? vec2(ASIDE, 0.0) : vec2(0.0, ASIDE);
        Sample beside = sample_at(s.patch_, net, view, s.middle + step_, centre);
        du[k] = (to_pixel(view, vec4(beside.jet.du, 0.0)) - s.qu) / ASIDE;
        dv[k] = (to_pixel(view, vec4(beside.jet.dv, 0.0)) - s.qv) / ASIDE;
    }
    s.quu = du[0];
    s.quv = 0.5 * (dv[0] + du[1]);
    s.qvv = dv[1];
    return s;
}

// Depth of a sheet at a point of the picture; UNSEEN if it is not there.
float depth_at(Sheet s, vec2 pixel) {
    vec2 uv = s.seen;
    vec2 miss;
    vec4 q;
    for (uint i = 0u; i < POINT_STEPS; ++i) {
        vec4 qu = s.qu + uv.x * s.quu + uv.y * s.quv;
        vec4 qv = s.qv + uv.x * s.quv + uv.y * s.qvv;
        q = s.q + 0.5 * (uv.x * (s.qu + qu) + uv.y * (s.qv + qv));
        miss = q.xy / q.w - pixel;
        vec2 step_;
        if (newton_step(pixels_along(q, qu, qv), miss, s.patch_, step_)) uv -= step_;
    }
    // a paraboloid also meets the ray behind the eye
    bool is = q.w > 0.0 && length(miss) <= ON_PIXEL_PX;
    is = is && is_there(s.fi, s.face, s.patch_instance, s.patch_, s.middle + uv);
#ifdef WITHIN_VOLUME
    is = is && in_volume(q, ON_PX);
#endif
    return is ? q.z : UNSEEN;
}

// Whether the face's depth jumps between the pixel and the one at `step_`: by more than to the other side.
bool jumps_to(ivec2 at, ivec2 step_, float own) {
    float ahead = imageLoad(resolved, at + step_).a - own;
    ivec2 other = at - step_;
    float back = is_in_picture(other) ? imageLoad(resolved, other).a - own : 0.0;
    return abs(ahead) >= abs(back) && jumps(back, ahead, own);
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
        // a second sheet of the pixel's own face
        if (own_patch && k > 0u && face == met[0] && jumps_to(at, beside - at, own_depth)) face |= 1u;
        bool known = met_count == MOST_SHEETS;
        for (uint i = 0u; i < met_count; ++i) known = known || met[i] == face;
        if (known) continue;
        met[met_count] = face;
        met_from[met_count++] = from;
    }
    // a separate loop: threads that run together find their sheets at different pixels
    for (uint n = 0u; n < met_count; ++n) {
        Sheet s = sheet_at(around(at, met_from[n]), vec2(at) + 0.5);
        for (uint i = 0u; i < BORDER_POINTS; ++i) {
            float depth = depth_at(s, vec2(at) + 0.5 + point_of(i));
            if (!(depth < depths[i])) continue;
            depths[i] = depth;
            shown[i] = met_from[n];
        }
    }
    if (SCENE_HAS_MESHES_OR_SOLIDS) {
        uint first = n * BORDER_POINTS;
        for (uint k = 0u; k < BORDER_POINTS; ++k) seen_points[first + k] = BorderPoint(depths[k], shown[k]);
        return;
    }
    vec4 sum = vec4(0.0);
    for (uint k = 0u; k < BORDER_POINTS; ++k) sum += shown_at(at, k, shown[k], no_patch);
    list[n].mean = packed_mean(sum);
}
