#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `line_list`: the lists of pixels that a chord's line covers, and of pixels beside which folds are looked for
// from the edge.
//
//    ●━━━━━━━━━━━━●   chord        distance of the pixel's centre ─▶ share of the pixel; of none, the pixel is not listed
//        · pixel   ╲
//                   ╲  next chord of the edge   a pixel that is nearer to it is listed with it alone
//
// Curves of small patches have chords much shorter than a pixel: without this each pixel would be listed with ten.
#include "scene.glsl"
#include "view.glsl"
#include "edges.glsl"
#include "joints.glsl"
#include "line_list.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
#include "grid.glsl"
layout(scalar, binding = 1) readonly buffer Chords { Chord chords[]; };
layout(scalar, binding = 2) buffer Points { LineList points; uint point_words[]; };
layout(scalar, binding = 3) buffer Seeds { LineList seeds; uint seed_words[]; };
layout(scalar, binding = 4) buffer CountersBuffer { Counters counters; };
layout(scalar, binding = 5) readonly buffer ChordSeeds { uint chord_seeds[]; }; // where outlines are drawn

layout(scalar, push_constant) uniform Push {
    vec3 half_px;
    uvec2 capacities; // of both lists
} push;

layout(location = 0) flat in uint chord;
layout(location = 1) flat in uint joins; // JOINS_*

// The point of the edge that belongs to a place of its chord is not so far from it.
const float CHORD_OFF_PX = 0.25;

// Pixels as near to two chords, but for rounding, are listed with both.
const float SAME_PX = 1.0 / 256.0;

// Outlines of curved faces are drawn.
layout(constant_id = 43) const bool DRAWS_FOLDS = false;

void put_point(uint pixel) {
    uint at = atomicAdd(points.count, 1u);
    bool fits = at < push.capacities.x;
    if (fits) {
        point_words[LINE_ITEM_WORDS * at] = pixel;
        point_words[LINE_ITEM_WORDS * at + 1u] = chord;
    }
    if (fits && !begins_group(at, 1u)) return;
    atomicMax(counters.line_points, at + 1u);
    if (!fits) atomicOr(counters.failed, FAILED_LINES);
    if (!fits) return;
    uvec3 grid = grid_of(at / LINE_GROUP + 1u);
    for (uint axis = 0u; axis < 3u; ++axis) atomicMax(points.grid[axis], grid[axis]);
}

// Seeds of the chord's edge, a bit each.
void put_seeds(uint pixel, uint bits) {
    uint count = uint(bitCount(bits));
    uint first = atomicAdd(seeds.count, count);
    uint at = first;
    for (uint left = bits; left != 0u; left &= left - 1u) {
        if (at < push.capacities.y) {
            seed_words[LINE_ITEM_WORDS * at] = pixel;
            seed_words[LINE_ITEM_WORDS * at + 1u] = chord | uint(findLSB(left) + 1) << LINE_SEED;
        }
        ++at;
    }
    uint end = first + count;
    bool fits = end <= push.capacities.y;
    if (fits && !begins_group(first, count)) return;
    atomicMax(counters.line_seeds, end);
    if (!fits) atomicOr(counters.failed, FAILED_LINES);
    uvec3 grid = grid_of((min(end, push.capacities.y) + LINE_GROUP - 1u) / LINE_GROUP);
    for (uint axis = 0u; axis < 3u; ++axis) atomicMax(seeds.grid[axis], grid[axis]);
}

// Distance of the pixel's centre from a chord.
float distance_from(Chord c) {
    vec2 along = c.b - c.a;
    vec2 from = gl_FragCoord.xy - c.a;
    float size = dot(along, along);
    float share = size > 0.0 ? clamp(dot(from, along) / size, 0.0, 1.0) : 0.0;
    return length(from - share * along);
}

void main() {
    Chord c = chords[chord];
    float off = distance_from(c);
    uint bits = DRAWS_FOLDS && off <= push.half_px.x + 0.5 + SEED_REACH_PX + CHORD_OFF_PX ? chord_seeds[chord] : 0u;
    float half_px = push.half_px[c.style & EDGE_STYLE];
    float covered = (c.style & EDGE_UNDRAWN) != 0u ? 0.0 : line_coverage(off, half_px);
    bool is_covered = uint(covered * LINE_STEPS + 0.5) != 0u;
    // the chord nearest to the pixel tells for those that it goes on from; it looks for folds if it may have any
    for (uint k = 0u; k < 2u; ++k) {
        bool joined = (joins & (k == 0u ? JOINS_BEFORE : JOINS_AFTER)) != 0u;
        bool asked = joined && (is_covered || bits != 0u);
        if (!asked) continue;
        uint beside = k == 0u ? chord - 1u : chord + 1u;
        if (!(distance_from(chords[beside]) < off - SAME_PX)) continue;
        is_covered = false;
        if (DRAWS_FOLDS && bits != 0u) bits &= ~chord_seeds[beside];
    }
    uint pixel = line_word(ivec2(gl_FragCoord.xy));
    if (is_covered) put_point(pixel);
    if (bits != 0u) put_seeds(pixel, bits);
}
