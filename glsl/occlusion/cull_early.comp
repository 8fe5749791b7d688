#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `cull_early`: patches that were hidden in the previous frame are not drawn, unless pass `cull_late` finds that
// they may be visible. One thread for each listed patch instance. Twin: src/twin/occlusion.rs.
#include "scene.glsl"

// All patches were hidden: those of parts that were hidden as a whole.
layout(constant_id = 40) const bool ALL_WERE_HIDDEN = false;

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Hidden { uint hidden[]; };
layout(scalar, binding = 2) buffer Taus { uint taus[]; };
layout(scalar, binding = 3) buffer CountersBuffer { Counters counters; };
#define RUNS_BINDING 4
#include "in_sight.glsl"

void main() {
    uint place = thread_number();
    if (place >= frame.listed_patch_instances) return;
    uint patch_instance = patch_instance_at(place);
    if (taus[patch_instance] == 0u) return;
    if (!ALL_WERE_HIDDEN && hidden[patch_instance] == 0u) return;
    taus[patch_instance] |= TAU_HIDDEN;
    atomicAdd(counters.hidden, 1u);
}
