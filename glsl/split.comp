#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `split`: one number of segments per shared side, and as many sub-patches as keep every
// number within the hardware's limit. One thread an item. Twin: src/twin/split.rs.
//
// Where a drawn neighbour may ask for another number, all numbers are powers of two: the tessellator
// joins a side to the interior within one cell's width then, else across several cells.
#include "scene.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer FaceInstances { FaceInstance face_instances[]; };
layout(scalar, binding = 2) readonly buffer Faces { Face faces[]; };
layout(scalar, binding = 3) readonly buffer Patches { Patch patches[]; };
layout(scalar, binding = 4) readonly buffer Items { uint item_face_instance[]; };
layout(scalar, binding = 5) readonly buffer Taus { uint taus[]; };
layout(scalar, binding = 6) writeonly buffer FactorsBuffer { Factors factors[]; };
// sub-patches and tessellated vertices of each item: first all items as plain, then all as trimmed
layout(scalar, binding = 7) writeonly buffer SubPatchCounts { uint sub_patch_counts[]; };
layout(scalar, binding = 8) writeonly buffer VertexCounts { uint vertex_counts[]; };

uint first_item;
uvec2 count;
bvec2 closed;

// tau along `axis` of the patch `steps` away across that axis; 0 beyond the border.
uint tau_at(ivec2 place, uint axis, int steps) {
    uint across = 1u - axis;
    int at = place[across] + steps;
    int n = int(count[across]);
    if (at < 0 || at >= n) {
        if (!closed[across]) return 0u;
        at = (at + 2 * n) % n; // one patch alone has itself two steps away, and % wants no negative
    }
    place[across] = at;
    uint t = taus[first_item + uint(place.y) * count.x + uint(place.x)];
    return axis == 0u ? t & 0xffffu : t >> 16;
}

uint power_of_two(uint x) { return x <= 1u ? 1u : 1u << (findMSB(x - 1u) + 1); }

// Sub-patches along the axis for a patch with these neighbours: enough that no shared side needs
// more than MAX_FACTOR segments in one sub-patch.
uint splits_for(uint before, uint own, uint after) {
    uint most = max(own, max(before, after));
    return min(power_of_two((most + MAX_FACTOR - 1u) / MAX_FACTOR), MAX_SPLIT);
}

uint round_up(uint x, uint step) { return (x + step - 1u) / step * step; }

void main() {
    uint item = gl_GlobalInvocationID.x;
    if (item >= frame.item_count) return;
    FaceInstance fi = face_instances[item_face_instance[item]];
    Face face = faces[fi.face];
    uint n = item - fi.first_item;
    uint side = side_of(patches[face.first_patch + n].shape);
    first_item = fi.first_item;
    count = uvec2(face.count_u, face.count_v);
    closed = bvec2((face.flags & FACE_CLOSED_U) != 0u, (face.flags & FACE_CLOSED_V) != 0u);
    ivec2 place = ivec2(n % count.x, n / count.x);
    uvec2 splits, inner, low, high;
    for (uint axis = 0u; axis < 2u; ++axis) {
        uint t[5];
        for (int k = 0; k < 5; ++k) t[k] = tau_at(place, axis, k - 2);
        uint before = splits_for(t[0], t[1], t[2]);
        uint own = splits_for(t[1], t[2], t[3]);
        uint after = splits_for(t[2], t[3], t[4]);
        splits[axis] = own;
        uint asked = max(t[2], 1u);
        bool low_met = t[1] != 0u;
        bool high_met = t[3] != 0u;
        inner[axis] = round_up(low_met || high_met ? power_of_two(asked) : asked, own);
        low[axis] = low_met ? max(power_of_two(max(t[1], asked)), max(before, own)) : inner[axis];
        high[axis] = high_met ? max(power_of_two(max(t[3], asked)), max(after, own)) : inner[axis];
    }
    bool drawn = taus[item] != 0u;
    factors[item] = Factors(inner.x | inner.y << 16, low.x | high.x << 16, low.y | high.y << 16,
                            splits.x | splits.y << 16);
    uvec2 most = max(inner, max(low, high)) / splits;
    uint patches_ = drawn ? splits.x * splits.y : 0u;
    uint vertices = patches_ * (most.x + 1u) * (most.y + 1u);
    uint plain = side == SIDE_INSIDE ? 1u : 0u;
    sub_patch_counts[item] = patches_ * plain;
    sub_patch_counts[frame.item_count + item] = patches_ * (1u - plain);
    vertex_counts[item] = vertices * plain;
    vertex_counts[frame.item_count + item] = vertices * (1u - plain);
}
