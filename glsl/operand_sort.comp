#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `operand_sort`: the fragments of each pixel by shell and depth, entering and leaving in turn. One
// thread a pixel.
// Twin: src/twin/operand_sort.rs.
//
//   mesh    E  E     L  L       how often the ray is within counts up and down; it is within where that is
//           E  ·     ·  L       not 0. A near plane in its box: begin so that the end is 0
//
//   faces   E  ·  L  L          the second L wants an entry: a ring's fragment E between the two, where the
//                 E? L          ray slips through a gap (`mended`), else it is left out
//           E  E  L             the second E, the reverse; at the end, too
//
//   Entries without an exit stay, exits without an entry go: both are `unpaired`, unless the camera's depth
//   range cuts the shell.
#include "scene.glsl"
#include "solids.glsl"
#include "shells.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Leaves { Leaf leaves[]; };
layout(scalar, binding = 2) readonly buffer LeafCentres { vec3 leaf_centres[]; };
layout(scalar, binding = 3) readonly buffer ShellLeaves { uint shell_leaves[]; };
layout(scalar, binding = 4) readonly buffer FragmentStarts { uint fragment_starts[]; };
layout(scalar, binding = 5) buffer FragmentCounts { uint fragment_counts[]; };
layout(scalar, binding = 6) buffer Fragments { Fragment fragments[]; };
layout(scalar, binding = 7) buffer CountersBuffer { Counters counters; };

const uint NONE = 0xffffffffu;

// A total order: two that are equal are the same.
bool before(Fragment a, Fragment b) {
    uint x = a.shell & FRAGMENT_SHELL;
    uint y = b.shell & FRAGMENT_SHELL;
    if (x != y) return x < y;
    if (a.depth != b.depth) return a.depth < b.depth;
    if (a.what != b.what) return a.what < b.what;
    if (a.shell != b.shell) return a.shell < b.shell;
    return a.uv < b.uv;
}

// D. L. Shell, A High-Speed Sorting Procedure, 1959, with the steps of M. Ciura, Best Increments for the
// Average Case of Shellsort, 2001: no storage, and far fewer steps than insertion where there are many.
const uint GAPS[11] = uint[](9881u, 4391u, 1750u, 701u, 301u, 132u, 57u, 23u, 10u, 4u, 1u);

void sort(uint first, uint count) {
    for (uint g = 0u; g < 11u; ++g) {
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

// The near plane in the box around a shell (1), the far plane (2).
uint cuts(uint shell) {
    Leaf leaf = leaves[shell_leaves[shell]];
    float middle = dot(frame.forward, leaf_centres[shell_leaves[shell]]);
    float reach = dot(abs(frame.forward), leaf.half_size);
    return (middle - reach < frame.near ? 1u : 0u) | (middle + reach > frame.far ? 2u : 0u);
}

void main() {
    uvec2 at = gl_GlobalInvocationID.xy;
    uvec2 size = uvec2(frame.size);
    if (at.x >= size.x) return;
    if (at == uvec2(0u)) {
        counters.fragments = fragment_starts[size.x * size.y];
        if (counters.fragments > frame.fragment_capacity) atomicOr(counters.failed, FAILED_FRAGMENTS);
    }
    uint pixel = at.y * size.x + at.x;
    uint first = fragment_starts[pixel];
    uint end = fragment_starts[pixel + 1u];
    if (end > frame.fragment_capacity) end = first; // the frame is recorded again
    sort(first, end - first);

    uint kept = first;
    uint shell = NONE;
    bool patches = false;
    uint cut = 0u;
    int number = 0;          // of a mesh: how often the ray is within
    bool group_within = false; // before the fragments of one depth
    Fragment owner;
    bool within = false;     // of faces
    bool lost = false;
    uint start = 0u;
    Fragment ring[2];        // the first ring's fragments since the last that was kept: entering, leaving
    bool has_ring[2] = bool[](false, false);
    for (uint i = first; i <= end; ++i) {
        bool more = i < end;
        Fragment f;
        if (more) f = fragments[i];
        bool next_shell = !more || (f.shell & FRAGMENT_SHELL) != shell;
        if (next_shell && shell != NONE) {
            // the shell before ends
            if (patches && within && has_ring[1]) {
                ring[1].shell = ring[1].shell & ~FRAGMENT_RING | start;
                fragments[kept] = ring[1];
                ++kept;
                within = false;
                atomicAdd(counters.mended, 1u);
            }
            bool open = lost || (patches ? within : number != 0);
            if (open && (cut & 2u) == 0u) atomicAdd(counters.unpaired, 1u);
        }
        if (!more) break;
        bool leaves_ = (f.shell & FRAGMENT_LEAVES) != 0u;
        if (next_shell) {
            shell = f.shell & FRAGMENT_SHELL;
            patches = (f.shell & FRAGMENT_PATCH) != 0u;
            cut = cuts(shell);
            number = 0;
            lost = false;
            within = false;
            has_ring = bool[](false, false);
            if ((cut & 1u) != 0u) {
                int sum = 0;
                bool found = false;
                for (uint k = i; k < end && (fragments[k].shell & FRAGMENT_SHELL) == shell; ++k) {
                    bool exits = (fragments[k].shell & FRAGMENT_LEAVES) != 0u;
                    sum += exits ? 1 : -1;
                    if (!found && (fragments[k].shell & FRAGMENT_RING) == 0u) {
                        within = exits;
                        found = true;
                    }
                }
                if (!patches) number = sum;
            }
            bool starts_within = patches ? within : number != 0;
            start = starts_within ? FRAGMENT_WITHIN : 0u;
            group_within = starts_within;
        }
        if (patches) {
            uint kind = leaves_ ? 1u : 0u;
            if ((f.shell & FRAGMENT_RING) != 0u) {
                if (!has_ring[kind]) ring[kind] = f;
                has_ring[kind] = true;
                continue;
            }
            if (leaves_ != within) {
                // one is missing between: of the other kind
                uint wanted = 1u - kind;
                if (!has_ring[wanted]) {
                    lost = lost || leaves_;
                    continue;
                }
                Fragment mend = ring[wanted];
                mend.shell = mend.shell & ~FRAGMENT_RING | start;
                fragments[kept] = mend;
                ++kept;
                atomicAdd(counters.mended, 1u);
            }
            within = !leaves_;
            has_ring = bool[](false, false);
            f.shell |= start;
            fragments[kept] = f;
            ++kept;
        } else {
            number += leaves_ ? -1 : 1;
            bool now = number != 0;
            if (now != group_within) owner = f;
            bool last = i + 1u >= end || (fragments[i + 1u].shell & FRAGMENT_SHELL) != shell ||
                        fragments[i + 1u].depth != f.depth;
            if (last && now != group_within) {
                owner.shell = shell | start | (now ? 0u : FRAGMENT_LEAVES);
                fragments[kept] = owner;
                ++kept;
            }
            if (last) group_within = now;
        }
    }
    fragment_counts[pixel] = kept - first;
}
