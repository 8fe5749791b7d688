// Division of one piece of an edge into chords: at most EDGE_TOLERANCE_PX beside it in the picture.
//
//   piece ─▶ outside a side of the picture, behind the eye, beyond the depth range?   left out
//         ─▶ EDGE_MOST_CHORDS are enough?   ──no──▶ halved
//              │ yes
//              ▼
//           equal steps of the parameter
//
// Source and proof of the bound: edges::flatten of the geometry crate, which does the same in f64. Twin:
// src/twin/edges.rs. `push.margin_px` is the distance beyond the picture to which lines are drawn. Needs scene.glsl,
// view.glsl, edges.glsl, `frame`, `samplerBuffer edge_points`, and
// `void put_chords(uint n, uint chords, float a, float b)`, which receives that many equal steps from a to b of `net`,
// of degree n.
#ifndef EDGE_DIVIDE_GLSL
#define EDGE_DIVIDE_GLSL

const uint EDGE_MOST_POINTS = 16u;
const uint EDGE_MOST_CHORDS = 16u;
// In pixels: a tenth, less the rounding.
const float EDGE_TOLERANCE_PX = 0.09;
// Most halvings: single precision resolves no finer parameters.
const uint EDGE_HALVINGS = 22u;

// Results for a piece.
const uint EDGE_OUTSIDE = 0u;
const uint EDGE_HALVES = 0xffffffffu;

// Control points of the current piece, in part coordinates.
vec4 net[EDGE_MOST_POINTS];

vec4 between(vec4 a, vec4 b, float t) {
    precise vec4 p = a * (1.0 - t) + b * t;
    return p;
}

// Sets `net` to the control points of the part of a piece from a to b.
void restrict_net(uint first, uint n, float a, float b) {
    for (uint i = 0u; i <= n; ++i) net[i] = texelFetch(edge_points, int(first + i));
    if (a > 0.0) {
        for (uint k = n; k > 0u; --k) {
            for (uint i = 0u; i < k; ++i) net[i] = between(net[i], net[i + 1u], a);
        }
    }
    if (b < 1.0) {
        precise float t = (b - a) / (1.0 - a);
        for (uint k = 1u; k <= n; ++k) {
            for (uint i = n; i >= k; --i) net[i] = between(net[i - 1u], net[i], t);
        }
    }
}

// The point of `net` at t, part coordinates.
vec4 net_at(uint n, float t) {
    if (t <= 0.0) return net[0];
    if (t >= 1.0) return net[n];
    vec4 p[EDGE_MOST_POINTS];
    for (uint i = 0u; i <= n; ++i) p[i] = net[i];
    for (uint k = n; k > 0u; --k) {
        for (uint i = 0u; i < k; ++i) p[i] = between(p[i], p[i + 1u], t);
    }
    return p[0];
}

// M(L) of the theorem, for one axis and one abscissa, without the factor n (n - 1).
float bend_at(vec3 before, vec3 middle, vec3 next, uint axis, float x) {
    precise float a = before[axis] - x * before.z;
    precise float b = middle[axis] - x * middle.z;
    precise float c = next[axis] - x * next.z;
    precise float bend = a - 2.0 * b + c;
    return abs(bend);
}

// The result for `net`: EDGE_OUTSIDE, EDGE_HALVES or a number of chords. `near`: it crosses the near plane.
uint fate_of(View view, uint n, out bool near) {
    vec2 last = frame.size + push.margin_px;
    uint outside = 63u;
    float least = 3.0e38;
    vec2 bend = vec2(0.0);
    vec3 before = vec3(0.0);
    vec3 middle = vec3(0.0);
    near = false;
    for (uint i = 0u; i <= n; ++i) {
        vec4 q = to_pixel(view, net[i]);
        precise float nearer = q.z - frame.near * net[i].w;
        precise float farther = q.z - frame.far * net[i].w;
        precise vec2 below = q.xy + push.margin_px * q.w;
        precise vec2 above = q.xy - last * q.w;
        uint here = 0u;
        here |= below.x < 0.0 ? 1u : 0u;
        here |= above.x > 0.0 ? 2u : 0u;
        here |= below.y < 0.0 ? 4u : 0u;
        here |= above.y > 0.0 ? 8u : 0u;
        here |= nearer < 0.0 ? 16u : 0u;
        here |= farther > 0.0 ? 32u : 0u;
        outside &= here;
        near = near || nearer < 0.0;
        least = min(least, q.w);
        vec3 next = q.xyw;
        if (i >= 2u) {
            for (uint axis = 0u; axis < 2u; ++axis) {
                bend[axis] = max(bend[axis], bend_at(before, middle, next, axis, -push.margin_px));
                bend[axis] = max(bend[axis], bend_at(before, middle, next, axis, last[axis]));
            }
        }
        before = middle;
        middle = next;
    }
    if (outside != 0u) return EDGE_OUTSIDE;
    if (near) return EDGE_HALVES;
    precise float bent = sqrt(bend.x * bend.x + bend.y * bend.y) * float(n * (n - 1u));
    precise float squared = bent / (8.0 * EDGE_TOLERANCE_PX * least);
    // large numbers and NaN are halved
    if (!(squared <= float(EDGE_MOST_CHORDS * EDGE_MOST_CHORDS))) return EDGE_HALVES;
    precise float chords = ceil(sqrt(squared));
    return max(uint(chords), 1u);
}

// Of a side of two triangles (EDGE_TURNS): one of them faces the eye and the other does not. In the picture, both lie
// on one side of it. Pixels are times W, and relative to the first end.
bool is_outline(EdgePiece piece, View view) {
    vec4 end = texelFetch(edge_points, int(piece.first));
    vec4 q = to_pixel(view, end);
    precise vec2 pixel = q.xy / q.w;
    vec2 ways[3];
    for (uint k = 0u; k < 3u; ++k) {
        precise vec4 way = texelFetch(edge_points, int(piece.first + k + 1u)) - end;
        vec4 moved = to_pixel(view, way);
        precise vec2 beside = moved.xy - pixel * moved.w;
        ways[k] = beside;
    }
    precise float first = ways[0].x * ways[1].y - ways[0].y * ways[1].x;
    precise float second = ways[0].x * ways[2].y - ways[0].y * ways[2].x;
    return (first < 0.0) == (second < 0.0);
}

// Visits the halves of a piece in order; true if one bends too much and cannot be halved further.
bool divide(EdgePiece piece, View view) {
    uint n = min(piece.degree, EDGE_MOST_POINTS - 1u);
    uint level = 0u;
    uint place = 0u;
    bool clamped = false;
    for (;;) {
        float width = 1.0 / float(1u << level);
        float a = float(place) * width;
        float b = float(place + 1u) * width;
        restrict_net(piece.first, n, a, b);
        bool near;
        uint fate = fate_of(view, n, near);
        if (fate == EDGE_HALVES && level < EDGE_HALVINGS) {
            ++level;
            place *= 2u;
            continue;
        }
        if (fate == EDGE_HALVES && !near) {
            clamped = true;
            fate = EDGE_MOST_CHORDS;
        }
        // the remaining part across the near plane is shorter than rounding
        if (fate != EDGE_OUTSIDE && fate != EDGE_HALVES) put_chords(n, fate, a, b);
        ++place;
        while (level > 0u && (place & 1u) == 0u) {
            place >>= 1u;
            --level;
        }
        if (level == 0u) return clamped;
    }
}

#endif
