#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `resolve`: the exact surface at the pixel's centre, then light.
//
// The visibility image holds (u, v) of the *tessellation* under the pixel. Newton's method moves it
// to the point of the exact surface that projects to the pixel's centre:
//     F(u, v) = projection(S(u, v)) - pixel = 0,   step = -J^-1 F,
// kept only while the distance to the pixel shrinks (a silhouette has no such point).
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
#include "shade.glsl"

layout(location = 0) out vec4 out_colour;
layout(location = 1) out float out_depth;
layout(location = 2) out uint out_face;
layout(location = 3) out vec2 out_uv;
layout(location = 4) out vec4 out_normal;

const uint NEWTON_STEPS = 4u;
const float MAX_STEP = 0.25;      // of the patch
const float CLOSE_ENOUGH = 1e-3;  // pixels

struct Sample {
    vec2 uv;
    Jet jet;
    vec4 q;      // homogeneous pixel
    vec2 miss;   // pixels
};

Sample sample_at(Patch patch_, View view, vec2 uv, vec2 pixel) {
    Sample s;
    s.uv = uv;
    s.jet = patch_jet(patch_.first, patch_.shape, uv);
    s.q = to_pixel(view, vec4(s.jet.point, 1.0));
    s.miss = s.q.xy / s.q.w - pixel;
    return s;
}

Sample refine(Patch patch_, View view, vec2 uv, vec2 pixel) {
    Sample best = sample_at(patch_, view, uv, pixel);
    for (uint i = 0u; i < NEWTON_STEPS; ++i) {
        float error = dot(best.miss, best.miss);
        if (error < CLOSE_ENOUGH * CLOSE_ENOUGH) break;
        vec4 qu = to_pixel(view, vec4(best.jet.du, 0.0));
        vec4 qv = to_pixel(view, vec4(best.jet.dv, 0.0));
        vec2 p = best.q.xy / best.q.w;
        vec2 pu = (qu.xy - p * qu.w) / best.q.w;
        vec2 pv = (qv.xy - p * qv.w) / best.q.w;
        float det = pu.x * pv.y - pu.y * pv.x;
        if (abs(det) < 1e-12) break;
        vec2 step_ = vec2(best.miss.x * pv.y - best.miss.y * pv.x, pu.x * best.miss.y - pu.y * best.miss.x) / det;
        float largest = max(abs(step_.x), abs(step_.y));
        if (largest > MAX_STEP) step_ *= MAX_STEP / largest;
        Sample next = sample_at(patch_, view, best.uv - step_, pixel);
        if (!(dot(next.miss, next.miss) < error)) break;
        best = next;
    }
    return best;
}

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
    if (seen.x == 0u) {
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
    uint item = seen.x - 1u;
    FaceInstance fi = face_instances[item_face_instance[item]];
    Face face = faces[fi.face];
    Patch patch_ = patches[face.first_patch + item - fi.first_item];
    Instance instance = instances[fi.instance];
    View view = views[fi.instance];
    vec2 pixel = gl_FragCoord.xy;
    Sample s = refine(patch_, view, unpackUnorm2x16(seen.y) * 3.0 - 1.0, pixel);
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
