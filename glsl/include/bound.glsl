// Shared by the passes that compute how finely patches are divided: finds the patches that may be visible. The entry
// point's `factors_of` computes their segments. One thread for each listed patch instance.
#ifndef BOUND_GLSL
#define BOUND_GLSL

#include "scene.glsl"
#include "view.glsl"

// Some closed part has no trims.
layout(constant_id = 24) const bool SCENE_HAS_CONES = false;

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Views { View views[]; };
layout(scalar, binding = 2) readonly buffer Instances { Instance instances[]; };
layout(scalar, binding = 3) readonly buffer FaceInstances { FaceInstance face_instances[]; };
layout(scalar, binding = 4) readonly buffer Faces { Face faces[]; };
#define PATCHES_BINDING 5
#include "patches.glsl"
layout(scalar, binding = 6) readonly buffer PatchInstances { uint patch_instances[]; };
layout(scalar, binding = 7) writeonly buffer Taus { uint taus[]; };
layout(scalar, binding = 8) buffer CountersBuffer { Counters counters; };
layout(scalar, binding = 9) readonly buffer Cones { vec4 cones[]; }; // only with SCENE_HAS_CONES
layout(binding = 10) uniform samplerBuffer points;                    // one a homogeneous control point

#define RUNS_BINDING 11
#include "in_sight.glsl"
#include "cone.glsl"

// Segments along u and v, whole numbers from 1 on.
vec2 factors_of(Patch patch_, View view, uint instance, Seen seen);

void main() {
    uint place = thread_number();
    if (place >= frame.listed_patch_instances) return;
    uint patch_instance = patch_instance_at(place);
    FaceInstance fi = face_instances[patch_instances[patch_instance]];
    Face face = faces[fi.face];
    uint index = face.first_patch + patch_instance - fi.first_patch_instance;
    Patch patch_ = patch_at(index);
    taus[patch_instance] = 0u;
    if (side_of(patch_.shape) == SIDE_OUTSIDE) return;
    View view = views[fi.instance];
    Seen seen = see(view, frame, patch_.box_min, patch_.box_max, frame.gap_radius_px + 1.0, far_of(face, frame));
    if (seen.w < 0.0) return;
    // nothing is drawn farther from the box; trimmed patches have skirts
    float beyond = frame.deviation_px + frame.spread_px + (side_of(patch_.shape) == SIDE_INSIDE ? 0.0 : frame.gap_radius_px);
    if (!covers_a_centre(seen, beyond)) return;
    if (SCENE_HAS_CONES && looks_away(view, frame, patch_, cones[index])) return;
    vec2 tau = frame.fixed_factor != 0u ? vec2(frame.fixed_factor) : factors_of(patch_, view, fi.instance, seen);
    if (max(tau.x, tau.y) > float(MAX_FACTOR * MAX_SPLIT)) atomicAdd(counters.clamps, 1u);
    uvec2 t = uvec2(min(tau, vec2(MAX_FACTOR * MAX_SPLIT)));
    taus[patch_instance] = t.x | t.y << 16;
}

#endif
