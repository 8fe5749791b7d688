#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `split` in scenes where faces share sides (Link). One thread a listed patch instance. Twin: src/twin/split.rs.
//
// Numbers of segments are compared as numbers for the whole curve of the ring: a side that is a quarter of it needs
// four times as many there, and gets a quarter of the result.
#include "split.glsl"

layout(scalar, binding = 10) readonly buffer Links { Link links[]; };

const uint NO_PATCH = 0xffffffffu;

uint instance_of_patch_0; // patch instances of a placed part have the order of its patches

uint tau_at(uint patch_, uint axis) { return tau_along(taus[instance_of_patch_0 + patch_], axis); }

uint axis_of(uint side) { return 1u - (side & 1u); }

uvec2 sides_of(uint axis) { return uvec2(1u - axis, 3u - axis); }

uint share(uint of_ring, Link link) {
    uint whole = 1u << link_halvings(link);
    return (of_ring + whole - 1u) / whole;
}

// The patch of the same face beyond a side.
uint patch_beyond(uint patch_, uint side) {
    Face face = faces[patch_at(patch_).face];
    uint n = patch_ - face.first_patch;
    uint across = side & 1u;
    uvec2 count = uvec2(face.count_u, face.count_v);
    uvec2 place = uvec2(n % count.x, n / count.x);
    bool closed = (face.flags & (across == 0u ? FACE_CLOSED_U : FACE_CLOSED_V)) != 0u;
    if (side >= 2u) {
        if (place[across] + 1u == count[across] && !closed) return NO_PATCH;
        place[across] = (place[across] + 1u) % count[across];
    } else {
        if (place[across] == 0u && !closed) return NO_PATCH;
        place[across] = (place[across] + count[across] - 1u) % count[across];
    }
    return face.first_patch + place.y * count.x + place.x;
}

// The largest tau of other patches along a side; 0 if none of them is drawn.
uint tau_beyond(uint patch_, uint side) {
    uint beyond = patch_beyond(patch_, side);
    if (beyond != NO_PATCH) return tau_at(beyond, axis_of(side));
    uint self = 4u * patch_ + side;
    Link own = links[self];
    if (!link_shared(own)) return 0u;
    uint most = 0u;
    uint at = own.next;
    for (uint k = 0u; k < LINK_MOST_SIDES && at != self; ++k) {
        Link link = links[at];
        most = max(most, tau_at(at >> 2, axis_of(at & 3u)) << link_halvings(link));
        at = link.next;
    }
    return share(most, own);
}

uint splits_of(uint patch_, uint axis) {
    uvec2 sides = sides_of(axis);
    return splits_for(tau_beyond(patch_, sides.x), tau_at(patch_, axis), tau_beyond(patch_, sides.y));
}

// The most sub-patches along a side, among the other patches that are drawn.
uint splits_beyond(uint patch_, uint side) {
    uint beyond = patch_beyond(patch_, side);
    if (beyond != NO_PATCH) return splits_of(beyond, axis_of(side));
    uint self = 4u * patch_ + side;
    Link own = links[self];
    if (!link_shared(own)) return 1u;
    uint most = 1u;
    uint at = own.next;
    for (uint k = 0u; k < LINK_MOST_SIDES && at != self; ++k) {
        Link link = links[at];
        uint axis = axis_of(at & 3u);
        if (tau_at(at >> 2, axis) != 0u) most = max(most, splits_of(at >> 2, axis) << link_halvings(link));
        at = link.next;
    }
    return share(most, own);
}

void main() {
    uint place_ = thread_number();
    if (place_ >= frame.listed_patch_instances) return;
    uint patch_instance = patch_instance_at(place_);
    FaceInstance fi = face_instances[patch_instances[patch_instance]];
    instance_of_patch_0 = fi.first_patch_instance - faces[fi.face].first_patch;
    uint patch_ = patch_instance - instance_of_patch_0;
    for (uint axis = 0u; axis < 2u; ++axis) {
        uvec2 sides = sides_of(axis);
        uvec2 others = uvec2(tau_beyond(patch_, sides.x), tau_beyond(patch_, sides.y));
        uvec2 others_splits = uvec2(splits_beyond(patch_, sides.x), splits_beyond(patch_, sides.y));
        decide(axis, tau_at(patch_, axis), others, others_splits);
    }
    write(place_, patch_instance, patch_);
}
