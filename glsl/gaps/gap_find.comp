#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `gap_find`: the list of gap candidates of a band of rows: what is seen is a candidate itself, or a skirt lies
// before it, or nothing is seen between patches. All of them get the mark. One thread a column of 30 pixels, whose
// neighbours' columns it learns from the threads beside it; the first and the last of a workgroup do nothing else.
//
//     bit   0   row above       a column's bits of what sees a patch, and those of the columns beside it:
//           1 ┐                 nothing is seen at x, but a and b see patches, on both sides
//           ⋮ │ 30 rows                                  a · ·   · a ·   · · a
//          30 ┘                                          · x ·   · x ·   · x ·   a x b
//          31   row below                                · · b   · b ·   b · ·
//
// Where the eye is within a solid, all its faces are seen from behind. What sees nothing else within WIDE_BAND_PX, nor any
// skirt, is not listed: the second step would have no candidate. A front between backs is listed, without the mark: through
// a crack in a face that is seen from behind, the next front shows.
#include "scene.glsl"
#include "visible.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
#include "grid.glsl"
layout(binding = 1, rg32ui) uniform uimage2D visibility;
layout(scalar, binding = 2) writeonly buffer GapCandidates { GapCandidate candidates[]; };
layout(scalar, binding = 3) buffer Bands { GapBand band_list; }; // zero before
layout(scalar, binding = 4) buffer CountersBuffer { Counters counters; };
layout(binding = 5) uniform sampler2D depth; // reversed
layout(binding = 6) uniform usampler2D border_depths; // the bits of depths
layout(scalar, push_constant) uniform Rows { uint first_row; }; // of the band

const uint GROUP = 64u; // threads of a workgroup of the next steps
const int LANES = 64;
const int ROWS = 30;
const int BAND = int(WIDE_BAND_PX);
const int COLUMNS = LANES - 2 + 2 * BAND; // of the workgroup, and beside it

shared uint patches_seen[LANES];
shared uint backs_seen[LANES];
shared uint full_columns; // of backs
shared uint among_backs[COLUMNS];

bool has_border(ivec2 pixel) { return texelFetch(border_depths, pixel, 0).x != 0u; }

// A solid's face from behind, without a skirt: what other threads mark has one, or sees nothing. Beside the picture there
// is nobody to ask either.
bool is_back(ivec2 pixel, ivec2 size) {
    if (any(lessThan(pixel, ivec2(0))) || any(greaterThanEqual(pixel, size))) return true;
    uint word = imageLoad(visibility, pixel).x;
    return (word & GAP_CANDIDATE) != 0u && !sees_nothing(word) && !has_border(pixel);
}

// A column's bits: nothing but backs up to BAND above and below.
uint backs_along(int column, int top, ivec2 size) {
    uint bits = 0u;
    int run = 0;
    for (int row = top + 1 - BAND; row <= top + ROWS + BAND; ++row) {
        run = is_back(ivec2(column, row), size) ? run + 1 : 0;
        if (run > 2 * BAND) bits |= 1u << uint(row - BAND - top);
    }
    return bits;
}

// Of a column's bits and those of the columns beside it: which pixels have set ones on opposite sides.
uint between(uint left, uint own, uint right) {
    uint sides = left & right;
    sides |= (own << 1) & (own >> 1);
    sides |= (left << 1) & (right >> 1);
    sides |= (left >> 1) & (right << 1);
    return sides;
}

void main() {
    int lane = int(gl_LocalInvocationID.x);
    int column = int(gl_WorkGroupID.x) * (LANES - 2) + lane - 1;
    int top = int(first_row) + int(gl_WorkGroupID.y) * ROWS - 1;
    ivec2 size = ivec2(frame.size);
    uint candidate = 0u;
    uint nothing = 0u;
    uint has_skirt = 0u; // a skirt is there
    uint border_before = 0u; // before what is seen
    uint patch_seen = 0u;
    if (lane == 0) full_columns = 0u;
    barrier();
    // other threads may write marks meanwhile, and earlier bands have: no bit below depends on them
    if (column >= 0 && column < size.x) {
        int first = max(top, 0);
        int last = min(top + ROWS + 1, size.y - 1);
        for (int row = first; row <= last; ++row) {
            uint word = imageLoad(visibility, ivec2(column, row)).x;
            uint bit = 1u << uint(row - top);
            if (sees_nothing(word)) nothing |= bit;
            else patch_seen |= bit;
            if ((word & GAP_CANDIDATE) != 0u) candidate |= bit;
            if (has_border(ivec2(column, row))) has_skirt |= bit;
        }
        // few have a skirt: the depth of the others is not looked at
        for (uint left_over = has_skirt; left_over != 0u; left_over &= left_over - 1u) {
            int row = top + findLSB(left_over);
            float skirt = uintBitsToFloat(texelFetch(border_depths, ivec2(column, row), 0).x);
            if (skirt > texelFetch(depth, ivec2(column, row), 0).x) border_before |= left_over & (~left_over + 1u);
        }
    }
    patches_seen[lane] = patch_seen;
    uint back = candidate & ~(has_skirt | nothing);
    backs_seen[lane] = back;
    uint own = ((1u << uint(ROWS)) - 1u) << 1;
    if ((back & own) == own) atomicAdd(full_columns, 1u);
    barrier();
    int to_ask = full_columns > 0u ? COLUMNS : 0;
    for (int k = lane; k < to_ask; k += LANES) {
        among_backs[k] = backs_along(int(gl_WorkGroupID.x) * (LANES - 2) - BAND + k, top, size);
    }
    barrier();
    uint unasked = to_ask > 0 ? candidate : 0u;
    for (int k = 0; k <= 2 * BAND && unasked != 0u; ++k) unasked &= among_backs[clamp(lane - 1 + k, 0, COLUMNS - 1)];
    if (lane == 0 || lane == LANES - 1 || column >= size.x) return;
    uint between_patches = between(patches_seen[lane - 1], patch_seen, patches_seen[lane + 1]);
    uint between_backs = between(backs_seen[lane - 1], back, backs_seen[lane + 1]);
    uint behind_skirt = border_before & candidate;
    border_before &= ~candidate;
    uint isolated = nothing & between_patches & ~(candidate | border_before);
    uint front = patch_seen & between_backs & ~(candidate | border_before);
    candidate &= ~unasked;
    uint listed = (candidate | border_before | isolated | front) & own;
    if (listed == 0u) return;
    uint count = uint(bitCount(listed));
    uint at = atomicAdd(band_list.count, count);
    atomicAdd(counters.gap_candidates, count);
    atomicMax(counters.band_gap_candidates, at + count);
    if (at + count > frame.gap_candidate_capacity) atomicOr(counters.failed, FAILED_GAP_CANDIDATES);
    uvec3 grid = grid_of((min(at + count, frame.gap_candidate_capacity) + GROUP - 1u) / GROUP);
    for (uint axis = 0u; axis < 3u; ++axis) atomicMax(band_list.grid[axis], grid[axis]);
    for (uint left_over = listed; left_over != 0u; left_over &= left_over - 1u) {
        uint k = uint(findLSB(left_over));
        ivec2 pixel = ivec2(column, top + int(k));
        uint bit = 1u << k;
        uint flags = (behind_skirt & bit) != 0u ? BACK_BEHIND_BORDER : 0u;
        if ((front & bit) != 0u) flags = FRONT_BETWEEN_BACKS;
        if (((candidate | front) & bit) == 0u) {
            flags = (isolated & bit) != 0u ? BORDER_BEFORE | ISOLATED : BORDER_BEFORE;
            uvec2 seen = imageLoad(visibility, pixel).xy;
            imageStore(visibility, pixel, uvec4(seen.x | GAP_CANDIDATE, seen.y, 0u, 0u));
        }
        if (at < frame.gap_candidate_capacity) candidates[at].pixel = uint(pixel.x) | uint(pixel.y) << 16 | flags;
        ++at;
    }
}
