// Pass `split`: its buffers, and the segments along one axis of a patch. The entry point finds the needs of the patches
// that share its sides.
//
// If a drawn neighbour may have another number of segments, all numbers are powers of two: then the tessellator joins a
// side to the interior within one cell's width, otherwise across several cells.
#include "scene.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer FaceInstances { FaceInstance face_instances[]; };
layout(scalar, binding = 2) readonly buffer Faces { Face faces[]; };
#define PATCHES_BINDING 3
#include "patches.glsl"
layout(scalar, binding = 4) readonly buffer PatchInstances { uint patch_instances[]; };
layout(scalar, binding = 5) readonly buffer Taus { uint taus[]; };
layout(scalar, binding = 6) writeonly buffer FactorsBuffer { Factors factors[]; };
// numbers of sub-patches and of vertices of each listed patch instance: first as members of list PLAIN_LIST, then of
// the others; a patch instance is a member of one list
layout(scalar, binding = 7) writeonly buffer SubPatchCounts { uint sub_patch_counts[]; };
layout(scalar, binding = 8) writeonly buffer VertexCounts { uint vertex_counts[]; };
#define RUNS_BINDING 9
#include "in_sight.glsl"

uint power_of_two(uint x) { return x <= 1u ? 1u : 1u << (findMSB(x - 1u) + 1); }

// Sub-patches along the axis, for a patch with these neighbours: no shared side then needs more than MAX_FACTOR
// segments in one sub-patch.
uint splits_for(uint before, uint own, uint after) {
    uint most = max(own, max(before, after));
    return min(power_of_two((most + MAX_FACTOR - 1u) / MAX_FACTOR), MAX_SPLIT);
}

uint round_up(uint x, uint step) { return (x + step - 1u) / step * step; }

uvec2 splits, inner, low, high;

// Segments of a side, whose other patches need `others` segments and have `others_splits` sub-patches; 0: there are
// none.
uint side_segments(uint own, uint others, uint others_splits, uint axis) {
    if (others == 0u) return inner[axis];
    uint n = max(power_of_two(max(others, own)), max(others_splits, splits[axis]));
    return min(n, MAX_FACTOR * splits[axis]);
}

// Segments of a patch along one axis, from its own needs and those of the other patches at its low and high side.
void decide(uint axis, uint own, uvec2 others, uvec2 others_splits) {
    splits[axis] = splits_for(others.x, own, others.y);
    own = max(own, 1u);
    inner[axis] = round_up(others != uvec2(0u) ? power_of_two(own) : own, splits[axis]);
    low[axis] = side_segments(own, others.x, others_splits.x, axis);
    high[axis] = side_segments(own, others.y, others_splits.y, axis);
}

void write(uint place, uint patch_instance, uint patch_) {
    bool drawn = is_drawn(taus[patch_instance]);
    factors[patch_instance] = Factors(inner.x | inner.y << 16, low.x | high.x << 16, low.y | high.y << 16,
                            splits.x | splits.y << 16);
    uvec2 segments = max(inner, max(low, high));
    uvec2 most = segments / splits;
    // the tessellator makes two segments of one along an axis, unless all numbers are one
    if (most != uvec2(1u)) most = max(most, 2u);
    uint sub_patches = drawn ? splits.x * splits.y : 0u;
    bool plain = side_of(patch_at(patch_).shape) == SIDE_INSIDE;
    bool by_corners = segments == uvec2(1u) && frame.corner_lists > (plain ? 0u : 1u);
    uint list = (by_corners ? CORNER_LIST : PLAIN_LIST) + (plain ? 0u : 1u);
    uint vertices = sub_patches * (by_corners ? CORNER_VERTICES : (most.x + 1u) * (most.y + 1u));
    for (uint k = 0u; k < 2u + frame.corner_lists; ++k) {
        uint slot = k * frame.listed_patch_instances + place;
        sub_patch_counts[slot] = k == list ? sub_patches : 0u;
        vertex_counts[slot] = k == list ? vertices : 0u;
    }
}
