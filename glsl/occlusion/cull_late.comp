#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `cull_late`: finds the patches that are hidden behind the surfaces drawn so far. Other patches that pass
// `cull_early` removed are drawn now; hidden patches are not drawn first in the next frame. One thread for each
// listed patch instance. Twin: src/twin/occlusion.rs.
#include "scene.glsl"
#include "view.glsl"
#include "tiles.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Views { View views[]; };
layout(scalar, binding = 2) readonly buffer Instances { Instance instances[]; };
layout(scalar, binding = 3) readonly buffer FaceInstances { FaceInstance face_instances[]; };
layout(scalar, binding = 4) readonly buffer Faces { Face faces[]; };
#define PATCHES_BINDING 5
#include "patches.glsl"
layout(binding = 6) uniform samplerBuffer points;
layout(scalar, binding = 7) readonly buffer PatchInstances { uint patch_instances[]; };
layout(scalar, binding = 8) readonly buffer Farthest { float farthest[]; };
layout(scalar, binding = 9) buffer Taus { uint taus[]; };
layout(scalar, binding = 10) writeonly buffer Hidden { uint hidden[]; };
layout(scalar, binding = 11) readonly buffer Outside { uvec2 outside[]; }; // for each patch: behind.glsl
layout(scalar, binding = 12) buffer CountersBuffer { Counters counters; };
#define RUNS_BINDING 13
#include "in_sight.glsl"

#include "patch.glsl"
#include "behind.glsl"

void main() {
    uint place = thread_number();
    if (place >= frame.listed_patch_instances) return;
    uint patch_instance = patch_instance_at(place);
    uint tau = taus[patch_instance];
    if (tau == 0u) {
        hidden[patch_instance] = 0u;
        return;
    }
    FaceInstance fi = face_instances[patch_instances[patch_instance]];
    uint index = faces[fi.face].first_patch + patch_instance - fi.first_patch_instance;
    bool is_hidden = lies_behind(patch_at(index), views[fi.instance], instances[fi.instance].scale, tau, outside[index]);
    hidden[patch_instance] = is_hidden ? 1u : 0u;
    bool appears = (tau & TAU_HIDDEN) != 0u && !is_hidden;
    taus[patch_instance] = appears ? tau & ~TAU_HIDDEN : tau | TAU_HIDDEN;
    if (appears) atomicAdd(counters.hidden, 0xffffffffu);
}
