#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `ambient_write`: darkens each pixel by the hidden share of its sky. The share is the mean over the eight pixels
// of a square of 4 x 4 that pass `ambient_find` has looked from, each along other slices. Pixels off the plane through
// this one have less weight. One thread a pixel.
#include "scene.glsl"
#include "view.glsl"
#include "shade.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rg32f) readonly uniform image2D ambient; // hidden share of the sky, depth; UNSEEN at the background
layout(binding = 2, rgba32f) uniform image2D resolved;       // linear colour, depth

layout(scalar, push_constant) uniform Push { float radius; } push;

float depth_at(ivec2 at) { return imageLoad(ambient, at).y; }

#include "ambient.glsl"

// Share of the colour that a wholly hidden sky takes away: 1 is black.
const float STRENGTH = 0.75;
// Pixels farther off the plane than this share of the radius have no weight.
const float OFF = 0.1;

// Change of the depth from one pixel to the next along an axis; 0 if both neighbours are background.
float slope(ivec2 at, ivec2 axis, float depth) {
    int way = like_beside(at, axis, depth);
    return way == 0 ? 0.0 : float(way) * (depth_at(at + way * axis) - depth);
}

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    bool shows_light = frame.style == STYLE_SHADED || frame.style == STYLE_CLAY;
    if (!is_in_picture(at) || !shows_light) return;
    vec2 own = imageLoad(ambient, at).xy;
    if (own.y >= UNSEEN) return;
    vec2 slopes = vec2(slope(at, ivec2(1, 0), own.y), slope(at, ivec2(0, 1), own.y));
    float sum = 0.0;
    float weights = 0.0;
    for (int i = 0; i < 8; ++i) {
        ivec2 way = ivec2(i & 3, i >> 2 << 1) - 2;
        way.y += (at.x + at.y + way.x + way.y) & 1; // column and row of the pixel have an even sum
        if (!is_in_picture(at + way)) continue;
        vec2 there = imageLoad(ambient, at + way).xy;
        float off = abs(there.y - own.y - dot(slopes, vec2(way)));
        float weight = max(1.0 - off / (OFF * push.radius), 0.0);
        sum += weight * there.x;
        weights += weight;
    }
    if (weights == 0.0) return; // a sliver between them
    vec4 seen = imageLoad(resolved, at);
    imageStore(resolved, at, vec4(seen.rgb * (1.0 - STRENGTH * sum / weights), seen.a));
}
