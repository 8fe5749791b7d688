// Whether a patch is hidden by the surfaces drawn so far. Twin: src/twin/occlusion.rs, which has the derivation.
//
//   ┌────┬────┬────┐   a patch is divided into cells of about CELL_PX. Every triangle of a cell is within `off` of
//   │    │    │    │   the bilinear surface through its corners. So its pixels lie within the corners' pixels, and some
//   ├────┼────┼────┤   around them, and its depth is at most a little nearer than the corners'. If every square there
//   │    │    │    │   is nearer, the cell does not change the picture
//   └────┴────┴────┘
#ifndef BEHIND_GLSL
#define BEHIND_GLSL

#include "nearer.glsl"
#include "push.glsl"

const float CELL_PX = 32.0;
const uint OUTSIDE_CELLS = 8u;
const uint MOST_CELLS = 8u; // along each parameter
const float DEPTH_ROUNDING = 1e-5; // of interpolated depths: more than STAND_BACK and rounding
const float PUSH_SLACK = 2.0; // factor: skirts may be pushed farther between a cell's corners

// A bound on the distance between the surface and its tangent within such a step.
float bend_over(Patch patch_, vec2 step_) {
    return dot(patch_.bend, vec3(step_.x * step_.x, 2.0 * step_.x * step_.y, step_.y * step_.y));
}

// Bounds |S_uv|.
float turn_of(Patch patch_) {
    return patch_.bend.y + sqrt(patch_.bend.x * patch_.bend.z);
}

// Whether no part of the face lies in a cell of `n` x `n`. `outside` has a bit for each of OUTSIDE_CELLS x
// OUTSIDE_CELLS cells, row by row from the lowest bit on.
bool is_outside(uvec2 outside, uvec2 cell, uint n) {
    uvec2 first = cell * OUTSIDE_CELLS / n;
    uvec2 end = max((cell + 1u) * OUTSIDE_CELLS / n, first + 1u);
    uint row = (1u << end.x) - (1u << first.x);
    for (uint y = first.y; y < end.y; ++y) {
        uint here = ((y < 4u ? outside.x : outside.y) >> (y % 4u * OUTSIDE_CELLS)) & 0xffu;
        if ((here & row) != row) return false;
    }
    return true;
}

// The pixels that a cell covers, and its nearest depth.
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

// Whether every pixel of the cover, and of `reach` pixels around it, shows something nearer.
bool is_covered(Cover c, float reach) {
    vec2 low = max(floor(c.low - reach), 0.0);
    vec2 high = min(ceil(c.high + reach), frame.size - 1.0);
    if (any(greaterThan(low, high))) return true; // outside the picture
    float z = reversed_depth(frame, c.depth) / (frame.perspective != 0u ? c.depth : 1.0);
    z += DEPTH_ROUNDING * z;
    return all_pixels_nearer(uvec2(low), uvec2(high), z);
}

// The cover of a cell of `n` x `n`, for triangles with segments of this size, including skirts beyond borders (with
// `all_sides` beyond every side of the cell), and the distance that they may reach beside its pixels. False if the cell
// reaches the near plane.
bool cover_cell(Patch patch_, View view, float scale, vec2 segment, uvec2 cell, uint n, bool all_sides, out Cover c,
                out float beside) {
    vec2 size = vec2(1.0 / float(n));
    // distance of triangles from the surface, and of the surface from the bilinear one, part units
    float chord = bend_over(patch_, segment) / 8.0;
    float off = chord + bend_over(patch_, size) / 8.0;
    uint borders = side_of(patch_.shape) == SIDE_BOUNDARY ? borders_of(patch_.shape) : 0u;
    float near = frame.near * (1.0 + DEPTH_ROUNDING);
    c = Cover(vec2(3.0e38), vec2(-3.0e38), 3.0e38);
    for (uint k = 0u; k < 4u; ++k) {
        uvec2 corner = cell + uvec2(k & 1u, k >> 1);
        Jet jet;
        if (n == 1u && borders == 0u && !all_sides) { // no derivatives are needed at the patch's own corners
            jet = Jet(patch_corner(patch_.first, patch_.shape, corner), vec3(0.0), vec3(0.0));
        } else {
            jet = patch_jet(patch_.first, patch_.shape, vec2(corner) / float(n));
        }
        vec4 q = to_pixel(view, vec4(jet.point, 1.0));
        if (q.z < near) return false;
        cover(c, q);
        // at borders; skirts from beside reach into cells that no part of the face covers
        uvec2 far = uvec2(k & 1u, k >> 1);
        bvec2 at_end = equal(cell + far, uvec2(far.x * n, far.y * n));
        uvec2 border = uvec2(far.x == 0u ? BORDER_U0 : BORDER_U1, far.y == 0u ? BORDER_V0 : BORDER_V1);
        vec2 outwards = vec2(0.0);
        if (at_end.x ? (borders & border.x) != 0u : all_sides) outwards.x = far.x == 0u ? -1.0 : 1.0;
        if (at_end.y ? (borders & border.y) != 0u : all_sides) outwards.y = far.y == 0u ? -1.0 : 1.0;
        if (outwards == vec2(0.0)) continue;
        vec4 qu = to_pixel(view, vec4(jet.du, 0.0));
        vec4 qv = to_pixel(view, vec4(jet.dv, 0.0));
        vec2 push = PUSH_SLACK * border_push(frame, q, qu, qv);
        push = min(push, min(vec2(MAX_PUSH), segment));
        vec4 pushed = q + outwards.x * push.x * qu + outwards.y * push.y * qv;
        if (pushed.z < near) return false;
        cover(c, pushed);
        float turned = turn_of(patch_) * (push.x * size.y + push.y * size.x) / 2.0;
        off = max(off, chord + bend_over(patch_, push) / 2.0 + turned);
    }
    c.depth -= off * scale;
    if (c.depth < near) return false;
    beside = off * scale * frame.focal * frame.slant / (frame.perspective != 0u ? c.depth : 1.0);
    return true;
}

bool lies_behind(Patch patch_, View view, float scale, uint tau, uvec2 outside) {
    vec2 segment = 1.0 / vec2(tau_along(tau, 0u), tau_along(tau, 1u));
    Cover c;
    float beside;
    if (!cover_cell(patch_, view, scale, segment, uvec2(0u), 1u, false, c, beside)) return false;
    vec2 span = c.high - c.low + 2.0 * beside;
    uint n = 1u;
    while (n < MOST_CELLS && max(span.x, span.y) > CELL_PX * float(n)) n *= 2u;
    bool some_outside = outside != uvec2(0u);
    if (n == 1u) return is_covered(c, beside + 1.0);
    uint asked = 0u;
    for (uint j = 0u; j < n; ++j) {
        for (uint i = 0u; i < n; ++i) {
            ++asked;
            if (is_outside(outside, uvec2(i, j), n)) continue;
            if (!cover_cell(patch_, view, scale, segment, uvec2(i, j), n, some_outside, c, beside)) return false;
            if (!is_covered(c, beside + 1.0)) return false;
        }
    }
    return asked == n * n;
}

#endif
