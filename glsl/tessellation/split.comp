#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `split`: one number of segments for each shared side, and enough sub-patches that no number exceeds the
// hardware's limit. One thread for each listed patch instance. Twin: src/twin/split.rs.
#include "split.glsl"

uint first_patch_instance;
uvec2 count;
bvec2 closed;

// tau along `axis` of the patch `steps` away across that axis; 0 beyond the border.
uint tau_at(ivec2 place, uint axis, int steps) {
    uint across = 1u - axis;
    int at = place[across] + steps;
    int n = int(count[across]);
    if (at < 0 || at >= n) {
        if (!closed[across]) return 0u;
        at = (at + 2 * n) % n; // a single patch is its own neighbour two steps away; % must not get a negative number
    }
    place[across] = at;
    return tau_along(taus[first_patch_instance + uint(place.y) * count.x + uint(place.x)], axis);
}

void main() {
    uint place_ = thread_number();
    if (place_ >= frame.listed_patch_instances) return;
    uint patch_instance = patch_instance_at(place_);
    FaceInstance fi = face_instances[patch_instances[patch_instance]];
    Face face = faces[fi.face];
    uint n = patch_instance - fi.first_patch_instance;
    first_patch_instance = fi.first_patch_instance;
    count = uvec2(face.count_u, face.count_v);
    closed = bvec2((face.flags & FACE_CLOSED_U) != 0u, (face.flags & FACE_CLOSED_V) != 0u);
    ivec2 place = ivec2(n % count.x, n / count.x);
    for (uint axis = 0u; axis < 2u; ++axis) {
        uint t[5];
        for (int k = 0; k < 5; ++k) t[k] = tau_at(place, axis, k - 2);
        uvec2 others_splits = uvec2(splits_for(t[0], t[1], t[2]), splits_for(t[2], t[3], t[4]));
        decide(axis, t[2], uvec2(t[1], t[3]), others_splits);
    }
    write(place_, patch_instance, face.first_patch + n);
}
