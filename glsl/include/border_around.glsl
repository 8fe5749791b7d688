// The points of a pixel at a border: each in a row and a column of its own; and the pixels around. Needs visible.glsl and
// shade.glsl.
//
//     ┌────────┐
//     │·       │     sixteen points; of scenes with patches alone Hammersley's
//     │    ·   │     shown: which of the nine pixels around sees the same, and lends its colour; NOBODY: none of what was
//     │  ·     │            asked is there
//     │      · │
//     └────────┘
#ifndef BORDER_AROUND_GLSL
#define BORDER_AROUND_GLSL

struct BorderPoint {
    float depth; // along the view axis; UNSEEN of nothing
    uint shown;
};

const uint BORDER_POINTS = 16u;
const uint AROUND = 9u; // pixels, the own one in the middle
const uint OWN = 4u;
const uint SLIVER = 9u; // a pixel farther away, which sees a sliver
const uint NOBODY = 15u;

// Rows of the points, four bits each, found by a random search: the share of points beside a straight line is 0.025 off
// that of the area on average, and 0.134 at most. Hammersley's are 0.031 and 0.139 off.
const uint ROWS_OF_FIRST = 0x50c84f2au;
const uint ROWS_OF_LAST = 0x6b1e73d9u;

vec2 point_of(uint k) {
    uint row = bitfieldReverse(k) >> 28;
    if (SCENE_HAS_MESHES_OR_SOLIDS) row = (k < 8u ? ROWS_OF_FIRST : ROWS_OF_LAST) >> (4u * (k % 8u)) & 15u;
    return (vec2(k, row) + 0.5) / float(BORDER_POINTS) - 0.5;
}

ivec2 around(ivec2 at, uint n) { return at + ivec2(n % 3u, n / 3u) - 1; }

// Pixel `n` around, or the one that sees the sliver.
ivec2 around_or_far(ivec2 at, uint n, uint sliver) {
    ivec2 way = ivec2(bitfieldExtract(int(sliver), 0, 16), int(sliver) >> 16);
    return n == SLIVER ? at + way : around(at, n);
}

// Which pixel, of those whose bit is set, is nearest to a point of the own one; NOBODY of none.
uint nearest_of(uint pixels, vec2 from) {
    uint nearest = NOBODY;
    float least = UNSEEN;
    for (uint n = 0u; n < AROUND; ++n) {
        vec2 way = vec2(n % 3u, n / 3u) - 1.0 - from;
        float distance_ = dot(way, way);
        if ((pixels >> n & 1u) == 0u || distance_ >= least) continue;
        least = distance_;
        nearest = n;
    }
    return nearest;
}

#endif
