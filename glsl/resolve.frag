#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`: the exact surface at the pixel's centre, then light.
//
// The visibility image holds (u, v) of the *tessellation* under the pixel; refine.glsl moves it to
// the point of the exact surface that projects to the pixel's centre.
#include "scene.glsl"
#include "view.glsl"

layout(constant_id = 3) const bool HAS_AOVS = false;

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
#include "shade.glsl"

layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_face;
layout(location = 3) out vec2 out_uv;
layout(location = 4) out vec4 out_normal;

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
    if (sees_solid(seen.x)) discard; // resolve_solids.frag
    if (sees_nothing(seen.x)) {
        if (frame.background.a < 0.0) discard; // the host keeps its picture
        out_colour = encode(frame.background, frame.encode_srgb);
        if (HAS_AOVS) {
            out_depth = uintBitsToFloat(0x7f800000u);
            out_face = 0u;
            out_uv = vec2(uintBitsToFloat(0x7fc00000u));
            out_normal = vec4(0.0);
        }
        gl_FragDepth = 0.0;
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
    vec4 own = unpackUnorm4x8(instance.colour);
    vec4 colour = own.a > 0.0 ? own : unpackUnorm4x8(face.colour);
    out_colour = encode(vec4(shade(colour.rgb, n, frame, (face.flags & FACE_SOLID) == 0u), 1.0), frame.encode_srgb);
    if (HAS_AOVS) {
        vec2 at = patch_.domain.xy + s.uv * patch_.domain.zw;
        out_depth = s.q.z;
        out_face = face.id;
        out_uv = face.domain.xy + at * face.domain.zw;
        out_normal = vec4(n, 1.0);
    }
    float range = 1.0 / (frame.far - frame.near);
    gl_FragDepth = (frame.far - s.q.z) * range * (frame.perspective != 0u ? frame.near / s.q.z : 1.0);
}
