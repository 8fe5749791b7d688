#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `ambient_find`: the share of the sky over a pixel's point that other points of the picture, within the radius,
// hide; of every second pixel, as on the black squares of a chess board. One thread for two pixels. Source: J. Jiménez,
// X. Wu, A. Pesce, A. Jarabo, Practical Realtime Strategies for Accurate Indirect Occlusion (SIGGRAPH course 2016): the
// integral over a slice has a closed form.
//
//        h0 ╲     ^ v     ╱ h1        a slice through the ray, in which u is orthogonal to v: surfaces within the
//            ╲    │    ╱              radius hide the sky below h0 and h1. The hidden share is
//      ▟▙     ╲   │ ╱   ▟▙               ((n v) (c0 c0 + c1 c1) + (n u) (a(c0) - a(c1))) / 2
//    ▟█▀▀▀▀▀▀▀▀▀▀▀●▀▀▀▀▀▀▀█▙              a(c) = acos c + c √(1 - c c)
//                                     c0 and c1: cosines between n within the slice and the horizons; 0 on a plane
//
// A pixel takes SLICES slices. The eight pixels of a square of 4 x 4 take different slices; pass `ambient_write` takes
// their mean.
#include "scene.glsl"
#include "view.glsl"
#include "shade.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rgba32f) readonly uniform image2D resolved;  // linear colour, depth; UNSEEN at the background
layout(binding = 2, rg32f) writeonly uniform image2D ambient;    // hidden share of the sky or 0, depth

layout(scalar, push_constant) uniform Push { float radius; } push; // in model units

float depth_at(ivec2 at) { return imageLoad(resolved, at).a; }

#include "ambient.glsl"

const float PI = 3.14159265;
const int SLICES = 2;
const int PIXELS = 8; // of a square of 4 x 4
const int HORIZON_STEPS = 4; // in each direction
// The radius in the picture is at most this share of its height: longer steps would jump over small surfaces.
const float MOST_HEIGHT = 0.2;
// Beyond this share of the radius the weight of a point falls, to 0 at the radius.
const float FADES = 0.75;

// a(c) of the figure.
float of_angle(float c) { return acos(c) + c * sqrt(1.0 - c * c); }

// Sine of the largest elevation over the tangent plane, of the points along one direction of the picture. The centres
// of pixels lie up to half a pixel beside the slice. That changes their angles with the ray, but points of a plane stay
// on the plane.
float elevation(ivec2 at, vec3 p, vec3 n, vec2 step_px, float first) {
    float highest = 0.0;
    for (int i = 0; i < HORIZON_STEPS; ++i) {
        float way = (float(i) + first) / float(HORIZON_STEPS);
        ivec2 beside = ivec2(floor(vec2(at) + 0.5 + step_px * way * way));
        float depth = depth_beside(beside);
        if (beside == at || depth >= UNSEEN) continue;
        vec3 d = point_at(beside, depth) - p;
        float far = length(d);
        float counts = clamp((1.0 - far / push.radius) / (1.0 - FADES), 0.0, 1.0);
        highest = max(highest, dot(d, n) / far * counts);
    }
    return highest;
}

// Hidden share of the sky over a point with normal `n`, towards the eye along `v`.
float hidden_at(ivec2 at, vec3 p, vec3 n, vec3 v, float reach_px) {
    // the sum and the difference of column and row are even
    int number = (((at.x + at.y) >> 1 & 1) << 2) + (at.x & 3);
    float first = (0.5 + float(((at.y - at.x) >> 1 & 1) + (at.x & 2))) / 4.0;
    float sum = 0.0;
    for (int i = 0; i < SLICES; ++i) {
        float turn = PI * (float(i) + float(number) / float(PIXELS)) / float(SLICES);
        vec2 direction = vec2(cos(turn), sin(turn));
        vec3 along = vec3(direction, 0.0);
        vec2 within = vec2(dot(n, v), dot(n, normalize(along - dot(along, v) * v))); // n in the slice
        // a direction of the slice at an angle a from n has the sine |within| cos a of its elevation
        float size = max(length(within), 1e-6);
        float before = min(elevation(at, p, n, -reach_px * direction, first) / size, 1.0);
        float after = min(elevation(at, p, n, reach_px * direction, first) / size, 1.0);
        float turned = within.y * (of_angle(before) - of_angle(after));
        sum += 0.5 * (within.x * (before * before + after * after) + turned);
    }
    return clamp(sum / float(SLICES), 0.0, 1.0);
}

void main() {
    ivec2 left = ivec2(gl_GlobalInvocationID.xy) * ivec2(2, 1);
    ivec2 at = left + ivec2(left.y & 1, 0);
    ivec2 other = left + ivec2(1 - (left.y & 1), 0);
    if (is_in_picture(other)) imageStore(ambient, other, vec4(0.0, depth_at(other), 0.0, 0.0));
    if (!is_in_picture(at)) return;
    float depth = depth_at(at);
    float hidden = 0.0;
    int x = 0;
    int y = 0;
    if (depth < UNSEEN) {
        x = like_beside(at, ivec2(1, 0), depth);
        y = like_beside(at, ivec2(0, 1), depth);
    }
    float reach_px = push.radius * frame.focal / (frame.perspective != 0u ? depth : 1.0);
    if (x != 0 && y != 0 && reach_px >= 1.0) {
        vec3 p = point_at(at, depth);
        vec3 right = float(x) * (point_at(at + ivec2(x, 0), depth_at(at + ivec2(x, 0))) - p);
        vec3 down = float(y) * (point_at(at + ivec2(0, y), depth_at(at + ivec2(0, y))) - p);
        vec3 v = frame.perspective != 0u ? -normalize(p) : vec3(0.0, 0.0, -1.0);
        vec3 n = normalize(cross(down, right));
        if (dot(n, v) < 0.0) n = -n;
        hidden = hidden_at(at, p, n, v, min(reach_px, MOST_HEIGHT * frame.size.y));
    }
    imageStore(ambient, at, vec4(hidden, depth, 0.0, 0.0));
}
