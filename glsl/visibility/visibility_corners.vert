#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `visibility`: patches of one segment a side, without tessellation stages. Six vertices a patch: two triangles,
// those of the tessellator.
//
//   u = 0, v = 0     0 ───── 1
//                    │     ╱ │      0 2 1, 1 2 3
//                    │   ╱   │
//                    2 ───── 3      a corner's number: u | v << 1
//
// A patch's corner is its control point, which the evaluation of visibility_surface.glsl returns there bit for bit. On
// the border of a trimmed face it is pushed beyond that as there. So a patch drawn by its corners meets its neighbours
// without a crack.
#include "scene.glsl"
#include "view.glsl"

layout(constant_id = 2) const bool TRIMMED = false;

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 8) readonly buffer SubPatches { SubPatch sub_patches[]; };
#include "placed.glsl"
#include "patch.glsl"
#include "border_vertex.glsl"

layout(location = 0) out vec2 out_uv; // of the patch
layout(location = 1) flat out uint out_patch_instance;

const uint CORNER_ORDER = 0xe58u; // two bits a vertex, the first vertex lowest

void main() {
    uint vertex = uint(gl_VertexIndex);
    uint corner = CORNER_ORDER >> 2u * (vertex % CORNER_VERTICES);
    uvec2 at = uvec2(corner & 1u, (corner >> 1) & 1u);
    uint patch_instance = sub_patches[vertex / CORNER_VERTICES].patch_instance;
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Patch patch_ = patch_at(face_at(fi.face).first_patch + patch_instance - fi.first_patch_instance);
    View view = view_at(fi.instance);
    vec2 uv = vec2(at);
    vec3 point = patch_corner(patch_.first, patch_.shape, at);
    if (TRIMMED) {
        uvec4 sides = uvec4(1u - at, at); // u = 0, v = 0, u = 1, v = 1
        uvec4 borders = borders_of(patch_.shape) & uvec4(BORDER_U0, BORDER_V0, BORDER_U1, BORDER_V1);
        bvec4 border = notEqual(sides * borders, uvec4(0u));
        if (any(border)) {
            Jet jet = patch_jet(patch_.first, patch_.shape, uv);
            push_border(patch_, view, border, vec2(1.0), uv, jet);
            point = jet.point;
        }
    }
    gl_Position = to_clip(frame, to_pixel(view, vec4(point, 1.0)));
    out_uv = uv;
    out_patch_instance = patch_instance;
}
