#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `operand_sort`: sorts the fragments of each pixel of the band by operand and depth, so that entries and exits
// alternate. One thread for each pixel of a part of the band; other pixels have no fragments. Twin:
// src/twin/operand_sort.rs.
//
//   mesh    E  E     L  L       a counter rises at entries and falls at exits; the ray is within where it is not 0.
//           E  ·     ·  L       If the near plane is in its box, the start value is such that the end is 0
//
//   faces   E  ·  L  L          the second L lacks an entry: a skirt's fragment E between the two supplies it, if the
//                 E? L          ray passes through a gap (`mended`); otherwise the L is removed
//           E  E  L             the second E, likewise; at the end, too
//
//           L  E  E  L          no skirt fits, but there are as many exits as entries: as for a mesh. Near a
//                               silhouette two fragments may be interchanged
//
//   An entry without an exit stays, an exit without an entry is removed: both are `unpaired`, unless the camera's
//   depth range cuts the operand.
#include "scene.glsl"
#include "solids.glsl"
#include "boundary_operands.glsl"
#include "tiles.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(scalar, binding = 2) readonly buffer LeafCentres { vec3 leaf_centres[]; };
layout(scalar, binding = 3) readonly buffer OperandLeaves { uint operand_leaves[]; };
layout(scalar, binding = 4) readonly buffer FragmentStarts { uint fragment_starts[]; };
layout(scalar, binding = 5) buffer FragmentCounts { uint fragment_counts[]; };
layout(scalar, binding = 6) buffer Fragments { Fragment fragments[]; };
layout(scalar, binding = 7) buffer CountersBuffer { Counters counters; };
layout(scalar, push_constant) uniform Part { uvec2 part_first; }; // column, and row of the band: a tile's first

// A total order: fragments that compare equal are equal.
bool before(Fragment a, Fragment b) {
    uint x = a.operand & FRAGMENT_OPERAND;
    uint y = b.operand & FRAGMENT_OPERAND;
    if (x != y) return x < y;
    if (a.depth != b.depth) return a.depth < b.depth;
    if (a.what != b.what) return a.what < b.what;
    if (a.operand != b.operand) return a.operand < b.operand;
    return a.uv < b.uv;
}

// D. L. Shell, A High-Speed Sorting Procedure, 1959, with the steps of M. Ciura, Best Increments for the
// Average Case of Shellsort, 2001: no storage, and far fewer steps than insertion where there are many.
const uint GAPS[11] = uint[](9881u, 4391u, 1750u, 701u, 301u, 132u, 57u, 23u, 10u, 4u, 1u);

void sort(uint first, uint count) {
    uint g = 0u; // the first step smaller than the list
    while (g < 10u && GAPS[g] >= count) ++g;
    for (; g < 11u; ++g) {
        uint gap = GAPS[g];
        for (uint i = gap; i < count; ++i) {
            Fragment f = fragments[first + i];
            uint j = i;
            while (j >= gap && before(f, fragments[first + j - gap])) {
                fragments[first + j] = fragments[first + j - gap];
                j -= gap;
            }
            if (j != i) fragments[first + j] = f;
        }
    }
}

// Whether the box around a boundary operand crosses the near plane (1), the far plane (2).
uint cuts(uint operand) {
    Leaf leaf = leaves[operand_leaves[operand]];
    float middle = dot(frame.forward, leaf_centres[operand_leaves[operand]]);
    float reach = dot(abs(frame.forward), leaf.half_size);
    return (middle - reach < frame.near ? 1u : 0u) | (middle + reach > frame.far ? 2u : 0u);
}

// End of the fragments that stay of the current operand.
uint kept;

void keep(Fragment f, uint bits) {
    f.operand = f.operand & ~(FRAGMENT_SKIRT | FRAGMENT_LEAVES) | bits;
    fragments[kept] = f;
    ++kept;
}

// Counts entries and exits, from `number` on; returns whether the count ends with 0.
bool by_winding(uint from, uint end, int number, uint start) {
    bool within = number != 0; // before the fragments of one depth
    Fragment owner;            // the last of them with the right direction
    bool any = false;
    float depth = 0.0;
    for (uint i = from; i <= end; ++i) {
        Fragment f;
        bool more = i < end;
        if (more) f = fragments[i];
        if (more && (f.operand & FRAGMENT_SKIRT) != 0u) continue;
        if (any && (!more || f.depth != depth)) {
            bool now = number != 0;
            if (now != within) keep(owner, start | (now ? 0u : FRAGMENT_LEAVES));
            within = now;
        }
        if (!more) break;
        number += (f.operand & FRAGMENT_LEAVES) != 0u ? -1 : 1;
        if ((number != 0) != within) owner = f;
        any = true;
        depth = f.depth;
    }
    return number == 0;
}

// Makes entries and exits alternate, with skirts' fragments where one is missing; returns whether they do. An entry
// without an exit is accepted if it stays, and not if the numbers must be equal. Writes the result only if `writes`.
bool in_turn(uint from, uint end, bool within, uint start, bool writes) {
    Fragment skirt[2]; // the first skirt fragments since the last fragment that stays: entry, exit
    bool has_skirt[2] = bool[](false, false);
    bool lost = false;
    for (uint i = from; i < end; ++i) {
        Fragment f = fragments[i];
        uint kind = (f.operand & FRAGMENT_LEAVES) != 0u ? 1u : 0u;
        if ((f.operand & FRAGMENT_SKIRT) != 0u) {
            if (!has_skirt[kind]) skirt[kind] = f;
            has_skirt[kind] = true;
            continue;
        }
        if ((kind == 1u) != within) {
            // a fragment of the other kind is missing between
            if (!has_skirt[1u - kind]) {
                lost = lost || kind == 1u || !writes;
                continue;
            }
            if (writes) {
                keep(skirt[1u - kind], start | (kind == 1u ? 0u : FRAGMENT_LEAVES));
                atomicAdd(counters.mended, 1u);
            }
        }
        within = kind == 0u;
        has_skirt = bool[](false, false);
        if (writes) keep(f, start | (f.operand & FRAGMENT_LEAVES));
    }
    if (within && has_skirt[1]) {
        if (writes) {
            keep(skirt[1], start | FRAGMENT_LEAVES);
            atomicAdd(counters.mended, 1u);
        }
        within = false;
    }
    return !within && !lost;
}

void main() {
    uvec2 at = part_first + gl_GlobalInvocationID.xy;
    uvec2 size = uvec2(uint(frame.size.x), band_rows(frame));
    if (at.x >= size.x) return;
    if (at == part_first) {
        uint wanted = fragment_starts[size.x * size.y];
        atomicAdd(counters.fragments, wanted);
        atomicMax(counters.band_fragments, wanted);
        if (wanted > frame.fragment_capacity) atomicOr(counters.failed, FAILED_FRAGMENTS);
    }
    uint pixel = at.y * size.x + at.x;
    uint first = fragment_starts[pixel];
    uint end = fragment_starts[pixel + 1u];
    if (at.x == part_first.x && at.y % TILE == 0u) {
        uint next_row = size.x * min(at.y + TILE, size.y);
        atomicMax(counters.row_fragments, fragment_starts[next_row] - fragment_starts[size.x * at.y]);
    }
    if (end < first) {
        // the count exceeds 32 bits
        atomicMax(counters.band_fragments, 0xffffffffu);
        atomicOr(counters.failed, FAILED_FRAGMENTS);
    }
    if (end < first || end > frame.fragment_capacity) end = first; // the frame is recorded again
    sort(first, end - first);

    kept = first;
    uint from = first;
    while (from < end) {
        uint operand = fragments[from].operand & FRAGMENT_OPERAND;
        bool patches = (fragments[from].operand & FRAGMENT_PATCH) != 0u;
        int sum = 0; // exits less entries
        bool leaves_first = false;
        bool any = false;
        uint stop = from;
        for (; stop < end; ++stop) {
            uint word = fragments[stop].operand;
            if ((word & FRAGMENT_OPERAND) != operand) break;
            if ((word & FRAGMENT_SKIRT) != 0u) continue;
            bool leaves_ = (word & FRAGMENT_LEAVES) != 0u;
            sum += leaves_ ? 1 : -1;
            if (!any) leaves_first = leaves_;
            any = true;
        }
        uint cut = cuts(operand);
        int number = (cut & 1u) != 0u ? sum : 0;
        bool within = (cut & 1u) != 0u && leaves_first;
        bool turns = patches;
        if (patches && sum == number) turns = in_turn(from, stop, within, 0u, false);
        bool starts_within = turns ? within : number != 0;
        uint start = starts_within ? FRAGMENT_WITHIN : 0u;
        bool closed;
        if (turns) closed = in_turn(from, stop, within, start, true);
        else closed = by_winding(from, stop, number, start);
        if (!closed && (cut & 2u) == 0u) atomicAdd(counters.unpaired, 1u);
        from = stop;
    }
    // count pixels whose loops a driver ended
    if (from != end) atomicAdd(counters.clamps, 1u);
    fragment_counts[pixel] = kept - first;
}
