#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`, patches and the background: the exact surface at the pixel's centre, then light.
//
// The visibility image holds (u, v) of the *tessellation* under the pixel; refine.glsl moves it to
// the point of the exact surface that projects to the pixel's centre.
#include "scene.glsl"
#include "view.glsl"

layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Views { View views[]; };
layout(scalar, binding = 2) readonly buffer FaceInstances { FaceInstance face_instances[]; };
layout(scalar, binding = 3) readonly buffer Faces { Face faces[]; };
layout(scalar, binding = 4) readonly buffer Patches { Patch patches[]; };
layout(scalar, binding = 5) readonly buffer Items { uint item_face_instance[]; };
layout(binding = 6) uniform samplerBuffer points;
layout(scalar, binding = 7) readonly buffer Instances { Instance instances[]; };
layout(binding = 8, rg32ui) readonly uniform uimage2D visibility;

#include "patch.glsl"
#include "refine.glsl"
#include "visible.glsl"
#include "resolved.glsl"

// S_u x S_v, or where it vanishes (pole, collapsed side) its limit from the patch's inside.
vec3 normal_of(Patch patch_, Jet jet, vec2 uv) {
    vec3 n = cross(jet.du, jet.dv);
    float size = dot(jet.du, jet.du) + dot(jet.dv, jet.dv);
    for (float step_ = 1e-3; step_ < 0.3 && dot(n, n) < 1e-10 * size * size; step_ *= 4.0) {
        Jet inner = patch_jet(patch_.first, patch_.shape, mix(uv, vec2(0.5), step_));
        n = cross(inner.du, inner.dv);
    }
    return n;
}

void main() {
    uvec2 seen = imageLoad(visibility, ivec2(gl_FragCoord.xy)).xy;
    if (sees_other(seen.x)) discard;
    if (sees_nothing(seen.x)) {
        write_nothing();
        return;
    }
    uint item = seen_item(seen.x);
    FaceInstance fi = face_instances[item_face_instance[item]];
    Face face = faces[fi.face];
    Patch patch_ = patches[face.first_patch + item - fi.first_item];
    Instance instance = instances[fi.instance];
    View view = views[fi.instance];
    vec2 pixel = gl_FragCoord.xy;
    Sample s = refine(patch_, view, unpack_uv(seen.y), pixel);
    vec3 n = normalize(instance.normal * normal_of(patch_, s.jet, s.uv));
    bool flip = ((face.flags & FACE_SAME_SENSE) == 0u) != (instance.mirrored != 0u);
    if (flip) n = -n;
    vec2 at = patch_.domain.xy + s.uv * patch_.domain.zw;
    bool solid = (face.flags & FACE_SOLID) != 0u;
    write_surface(face.colour, instance, n, solid, s.q.z, face.id, face.domain.xy + at * face.domain.zw);
}
