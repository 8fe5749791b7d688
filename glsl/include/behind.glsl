// Whether a patch lies behind what has been drawn. Twin: src/twin/hidden.rs, which derives it.
//
//   ┌────┬────┬────┐   a patch is cut in cells of some CELL_PX; every triangle of a cell lies within `off` of what is
//   │    │    │    │   bilinear through its corners. So it is seen within the corners' pixels, and a few more, and
//   ├────┼────┼────┤   nowhere nearer than they are, and a little. If all tiles there see something nearer, nothing
//   │    │    │    │   of it changes the picture
//   └────┴────┴────┘
#ifndef BEHIND_GLSL
#define BEHIND_GLSL

#include "farthest.glsl"
#include "farthest.glsl"
#include "push.glsl"

const float CELL_PX = 32.0;
const uint MOST_CELLS = 16u; // along each parameter
const uint MOST_SQUARES = 10u; // that a cell asks along each axis; else it asks larger ones
const float DEPTH_ROUNDING = 1e-5; // of depths that the rasteriser interpolates: above STAND_BACK and its own
const float PUSH_SLACK = 2.0; // what is pushed at a cell's corners is up to so much more between them

// By how much the surface may leave its tangent within such a step.
float bend_over(Patch patch_, vec2 step_) {
    return dot(patch_.bend, vec3(step_.x * step_.x, 2.0 * step_.x * step_.y, step_.y * step_.y));
}

// What a cell covers: pixels, and how near it comes.
struct Cover {
    vec2 low;
    vec2 high;
    float depth;
};

void cover(inout Cover c, vec4 q) {
    vec2 pixel = q.xy / q.w;
    c.low = min(c.low, pixel);
    c.high = max(c.high, pixel);
    c.depth = min(c.depth, q.z);
}

// All that is seen from the first to the last square of that side is nearer than `z`.
bool all_nearer(uvec2 first, uvec2 last, uint side, float z) {
    uint base = first_square(frame, side);
    uint across = square_count(frame, side).x;
    for (uint y = first.y; y <= last.y; ++y) {
        for (uint x = first.x; x <= last.x; ++x) {
            if (!(farthest[base + y * across + x] > z)) return false;
        }
    }
    return true;
}

// No pixel shows anything of what covers this, and `reach` pixels around it.
bool is_covered(Cover c, float reach) {
    vec2 low = max(floor(c.low - reach), 0.0);
    vec2 high = min(ceil(c.high + reach), frame.size - 1.0);
    if (any(greaterThan(low, high))) return true; // beside the picture
    float z = reversed_depth(frame, c.depth) / (frame.perspective != 0u ? c.depth : 1.0);
    z += DEPTH_ROUNDING * z;
    uint side = TILE * BLOCK;
    if (all(lessThan(uvec2(high) / TILE - uvec2(low) / TILE, uvec2(MOST_SQUARES)))) side = TILE;
    if (all(lessThan(uvec2(high) / SQUARE - uvec2(low) / SQUARE, uvec2(MOST_SQUARES)))) side = SQUARE;
    return all_nearer(uvec2(low) / side, uvec2(high) / side, side, z);
}

// What a cell of `n` x `n` covers, triangles of these segments' size and what is pushed beyond borders among it, and how
// far beside its pixels that may be. False where it comes before the near plane.
bool cover_cell(Patch patch_, View view, float scale, vec2 segment, uvec2 cell, uint n, out Cover c, out float beside) {
    vec2 size = vec2(1.0 / float(n));
    // of triangles from the surface, of the surface from what is bilinear, part units
    float chord = bend_over(patch_, segment) / 8.0;
    float off = chord + bend_over(patch_, size) / 8.0;
    uint borders = side_of(patch_.shape) == SIDE_BOUNDARY ? borders_of(patch_.shape) : 0u;
    float near = frame.near * (1.0 + DEPTH_ROUNDING);
    c = Cover(vec2(3.0e38), vec2(-3.0e38), 3.0e38);
    for (uint k = 0u; k < 4u; ++k) {
        vec2 uv = vec2(cell + uvec2(k & 1u, k >> 1)) / float(n);
        Jet jet = patch_jet(patch_.first, patch_.shape, uv);
        vec4 q = to_pixel(view, vec4(jet.point, 1.0));
        if (q.z < near) return false;
        cover(c, q);
        vec2 outwards = vec2(0.0);
        if (uv.x == 0.0 && (borders & BORDER_U0) != 0u) outwards.x = -1.0;
        if (uv.x == 1.0 && (borders & BORDER_U1) != 0u) outwards.x = 1.0;
        if (uv.y == 0.0 && (borders & BORDER_V0) != 0u) outwards.y = -1.0;
        if (uv.y == 1.0 && (borders & BORDER_V1) != 0u) outwards.y = 1.0;
        if (outwards == vec2(0.0)) continue;
        vec4 qu = to_pixel(view, vec4(jet.du, 0.0));
        vec4 qv = to_pixel(view, vec4(jet.dv, 0.0));
        vec2 push = PUSH_SLACK * border_push(frame, q, qu, qv);
        push = min(push, min(vec2(MAX_PUSH), segment));
        vec4 pushed = q + outwards.x * push.x * qu + outwards.y * push.y * qv;
        if (pushed.z < near) return false;
        cover(c, pushed);
        float turned = patch_.bend.y * (push.x * size.y + push.y * size.x) / 2.0;
        off = max(off, chord + bend_over(patch_, push) / 2.0 + turned);
    }
    c.depth -= off * scale;
    if (c.depth < near) return false;
    beside = off * scale * frame.focal * frame.slant / (frame.perspective != 0u ? c.depth : 1.0);
    return true;
}

bool lies_behind(Patch patch_, View view, float scale, uint tau) {
    vec2 segment = 1.0 / vec2(tau_along(tau, 0u), tau_along(tau, 1u));
    Cover c;
    float beside;
    if (!cover_cell(patch_, view, scale, segment, uvec2(0u), 1u, c, beside)) return false;
    vec2 span = c.high - c.low + 2.0 * beside;
    uint n = uint(clamp(ceil(max(span.x, span.y) / CELL_PX), 1.0, float(MOST_CELLS)));
    if (n == 1u) return is_covered(c, beside + 1.0);
    for (uint j = 0u; j < n; ++j) {
        for (uint i = 0u; i < n; ++i) {
            if (!cover_cell(patch_, view, scale, segment, uvec2(i, j), n, c, beside)) return false;
            if (!is_covered(c, beside + 1.0)) return false;
        }
    }
    return true;
}

#endif
