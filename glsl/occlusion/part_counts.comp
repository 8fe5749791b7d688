#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `part_counts`: which placed parts in sight are listed. One thread for each part in sight. Twin:
// src/twin/parts.rs.
#include "scene.glsl"
#include "parts.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, push_constant) uniform Push { PartList push; };
layout(scalar, binding = 0) readonly buffer PartsInSight { PartInSight parts[]; };
layout(scalar, binding = 1) buffer HiddenBefore { uint hidden_before[]; };
layout(scalar, binding = 2) readonly buffer HiddenNow { uint hidden_now[]; };
// of each part in sight: patch instances, if it is listed; then whether a run of patch instances begins with it
layout(scalar, binding = 3) writeonly buffer PartCounts { uint part_counts[]; };
layout(scalar, binding = 4) buffer CountersBuffer { Counters counters; };

// For LIST_FIRST `hidden_before` is not read: this pass writes it then.
bool is_listed(uint group) {
    bool now = hidden_now[group] != 0u;
    bool before = push.list == LIST_FIRST || hidden_before[group] != 0u;
    return push.list == LIST_ALL ? !(before && now) : before && !now;
}

void main() {
    uint n = thread_number();
    if (n >= push.parts) return;
    PartInSight part = parts[n];
    bool listed = is_listed(part.group);
    if (push.list == LIST_FIRST) hidden_before[part.group] = hidden_now[part.group];
    bool follows = false;
    if (n > 0u) {
        PartInSight last = parts[n - 1u];
        follows = last.first_patch_instance + last.patch_instances == part.first_patch_instance &&
                  is_listed(last.group);
    }
    part_counts[n] = listed ? part.patch_instances : 0u;
    part_counts[push.parts + n] = listed && !follows ? 1u : 0u;
    if (push.list == LIST_FIRST && !listed) atomicAdd(counters.hidden_parts, 1u);
    if (push.list == LIST_APPEARING && listed) atomicAdd(counters.hidden_parts, 0xffffffffu);
}
