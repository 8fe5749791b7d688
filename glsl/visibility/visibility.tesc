#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `visibility`: levels of one sub-patch. Sides that lie on a side of the whole patch get that
// side's own number of segments; sides inside the patch get the patch's.
#include "scene.glsl"
#include "view.glsl"

layout(constant_id = 10) const bool SCENE_HAS_OPERANDS = false;
layout(constant_id = 11) const bool DRAWS_OPERANDS = false;

layout(vertices = 1) out;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 7) readonly buffer FactorsBuffer { Factors factors[]; };
layout(scalar, binding = 8) readonly buffer SubPatches { SubPatch sub_patches[]; };

#include "placed.glsl"
#include "patch.glsl"

layout(location = 0) flat in uint sub_patch[];
layout(location = 0) patch out uint out_patch_instance;
layout(location = 1) patch out uint out_instance;
layout(location = 2) patch out uint out_patch;
layout(location = 3) patch out uvec2 out_place;
layout(location = 4) patch out uvec2 out_splits;
layout(location = 5) patch out uvec4 out_edges; // segments of the patch's sides u = 0, v = 0, u = 1, v = 1

// A split patch may reach far beyond the picture: sub-patches outside it are left out. Every point of one lies within
// `bend / 8 n^2` of the bilinear surface through its corners.
bool seen(Patch patch_, View view, vec2 lo, vec2 hi, float far) {
    vec3 a = patch_jet(patch_.first, patch_.shape, lo).point;
    vec3 b = patch_jet(patch_.first, patch_.shape, hi).point;
    vec3 c = patch_jet(patch_.first, patch_.shape, vec2(lo.x, hi.y)).point;
    vec3 d = patch_jet(patch_.first, patch_.shape, vec2(hi.x, lo.y)).point;
    vec2 size = hi - lo;
    float off = (patch_.bend.x * size.x * size.x + 2.0 * patch_.bend.y * size.x * size.y +
                 patch_.bend.z * size.y * size.y) / 8.0;
    vec3 low = min(min(a, b), min(c, d)) - off;
    vec3 high = max(max(a, b), max(c, d)) + off;
    return see(view, frame, low, high, frame.gap_radius_px + 1.0, far).w >= 0.0;
}

void main() {
    SubPatch sub = sub_patches[sub_patch[0]];
    FaceInstance fi = face_instance_at(face_instance_of(sub.patch_instance));
    uint index = face_at(fi.face).first_patch + sub.patch_instance - fi.first_patch_instance;
    Factors f = factors[sub.patch_instance];
    uvec2 splits = uvec2(f.splits & 0xffffu, f.splits >> 16);
    uvec2 place = uvec2(sub.place & 0xffu, sub.place >> 8);
    uvec2 inner = uvec2(f.inner & 0xffffu, f.inner >> 16) / splits;
    uvec4 edges = uvec4(f.edge_v & 0xffffu, f.edge_u & 0xffffu, f.edge_v >> 16, f.edge_u >> 16);
    out_patch_instance = sub.patch_instance;
    out_instance = fi.instance;
    out_patch = index;
    out_place = place;
    out_splits = splits;
    out_edges = edges;
    uvec4 outer;
    outer.x = place.x == 0u ? edges.x / splits.y : inner.y;
    outer.y = place.y == 0u ? edges.y / splits.x : inner.x;
    outer.z = place.x + 1u == splits.x ? edges.z / splits.y : inner.y;
    outer.w = place.y + 1u == splits.y ? edges.w / splits.x : inner.x;
    // the draw also contains faces of operands
    bool operand = (face_at(fi.face).flags & FACE_OPERAND) != 0u;
    if (SCENE_HAS_OPERANDS && operand != DRAWS_OPERANDS) outer = uvec4(0u);
    if (splits != uvec2(1u)) {
        vec2 lo = vec2(place) / vec2(splits);
        vec2 hi = vec2(place + 1u) / vec2(splits);
        if (!seen(patch_at(index), view_at(fi.instance), lo, hi, far_of(face_at(fi.face), frame))) outer = uvec4(0u);
    }
    gl_TessLevelOuter[0] = float(outer.x);
    gl_TessLevelOuter[1] = float(outer.y);
    gl_TessLevelOuter[2] = float(outer.z);
    gl_TessLevelOuter[3] = float(outer.w);
    gl_TessLevelInner[0] = float(inner.x);
    gl_TessLevelInner[1] = float(inner.y);
}
