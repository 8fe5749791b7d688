#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `ambient_write`: what is hidden from the sky is darker. The mean of a square of four by four pixels has each of the slices of
// pass `ambient_find` once; pixels off the plane through the own one count less.
#include "scene.glsl"
#include "view.glsl"
#include "shade.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rg32f) readonly uniform image2D ambient;  // hidden share of the sky, depth; UNSEEN where nothing is
layout(binding = 2, rgba32f) uniform image2D resolved;        // linear colour, depth

layout(scalar, push_constant) uniform Push { float radius; } push;

float depth_at(ivec2 at) { return imageLoad(ambient, at).y; }

#include "ambient.glsl"

// How dark it is where no sky is seen: 1 is black.
const float STRENGTH = 0.75;
// Pixels this share of the radius off the plane do not count.
const float OFF = 0.1;

// How much the depth changes from pixel to pixel.
float slope(ivec2 at, ivec2 axis, float depth) {
    int way = like_beside(at, axis, depth);
    return way == 0 ? 0.0 : float(way) * (depth_at(at + way * axis) - depth);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    bool shows_light = frame.style == STYLE_SHADED || frame.style == STYLE_CLAY;
    if (!in_picture(at) || !shows_light) return;
    vec2 own = imageLoad(ambient, at).xy;
    if (own.y >= UNSEEN) return;
    vec2 slopes = vec2(slope(at, ivec2(1, 0), own.y), slope(at, ivec2(0, 1), own.y));
    float sum = 0.0;
    float weights = 0.0;
    for (int i = 0; i < 16; ++i) {
        ivec2 way = ivec2(i & 3, i >> 2) - 2;
        if (!in_picture(at + way)) continue;
        vec2 there = imageLoad(ambient, at + way).xy;
        float off = abs(there.y - own.y - dot(slopes, vec2(way)));
        float weight = max(1.0 - off / (OFF * push.radius), 0.0);
        sum += weight * there.x;
        weights += weight;
    }
    vec4 seen = imageLoad(resolved, at);
    imageStore(resolved, at, vec4(seen.rgb * (1.0 - STRENGTH * sum / weights), seen.a));
}
