#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `visibility`, trimmed patches: the same after the trim test.
//
// Two faces that meet along an edge are trimmed apart from each other, each with its own rounding;
// a pixel in the gap would show what lies behind. So a face that looks at the viewer also takes the
// pixels of a ring, ring_px wide, outside its border.
//
//      inside │ ring │ outside        in the ring the surface is continued, but never nearer to the
//   ──────────┼╌╌╌╌╌╌│                viewer than the border that it continues: a floor seen from a
//             │                       low angle must not flow over what stands before its edge
//
// Faces of a solid that look away are never seen; they give the ring up on their own side, so that
// none peeps out behind a silhouette.
#include "scene.glsl"

layout(scalar, binding = 0) readonly buffer Frames { Frame frame; };
layout(scalar, binding = 2) readonly buffer FaceInstances { FaceInstance face_instances[]; };
layout(scalar, binding = 3) readonly buffer Faces { Face faces[]; };
layout(scalar, binding = 4) readonly buffer Patches { Patch patches[]; };
layout(scalar, binding = 5) readonly buffer Items { uint item_face_instance[]; };
layout(scalar, binding = 9) readonly buffer Instances { Instance instances[]; };
layout(scalar, binding = 10) readonly buffer LineStarts { uint line_starts[]; };
layout(scalar, binding = 11) readonly buffer RowStarts { uint row_starts[]; };
layout(scalar, binding = 12) readonly buffer RowCounts { uint row_counts[]; };
layout(scalar, binding = 13) readonly buffer Flips { float flips[]; };

#include "table.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint item;
layout(location = 0) out uvec2 visible;
layout(depth_less) out float gl_FragDepth;

const uint RING_POINTS = 8u;
const float DIAGONAL = 0.70710678;
const vec2 RING[RING_POINTS] = vec2[](vec2(1, 0), vec2(0, 1), vec2(-1, 0), vec2(0, -1), vec2(DIAGONAL, DIAGONAL),
                                      vec2(-DIAGONAL, DIAGONAL), vec2(-DIAGONAL, -DIAGONAL), vec2(DIAGONAL, -DIAGONAL));

void main() {
    FaceInstance fi = face_instances[item_face_instance[item]];
    Face face = faces[fi.face];
    Patch patch_ = patches[face.first_patch + item - fi.first_item];
    vec2 at = patch_.domain.xy + uv * patch_.domain.zw;
    vec2 dx = dFdx(uv) * patch_.domain.zw;
    vec2 dy = dFdy(uv) * patch_.domain.zw;
    vec2 slope = vec2(dFdx(gl_FragCoord.z), dFdy(gl_FragCoord.z));
    float strips = float(face.strip_count);
    // (u, v) runs against the screen's (right, down) where the normal S_u x S_v looks at the viewer
    bool towards = (dx.x * dy.y - dx.y * dy.x < 0.0) == ((face.flags & FACE_SAME_SENSE) != 0u);
    if (instances[fi.instance].mirrored != 0u) towards = !towards;
    bool solid = (face.flags & FACE_SOLID) != 0u;
    bool hidden = solid && !towards;
    bool inside = table_inside(fi.first_strip, strips, at);
    float border_depth = -1.0; // nearest to the viewer among the ring's points inside the face
    if (inside == hidden) {
        uint around = 0u;
        for (uint k = 0u; k < RING_POINTS; ++k) {
            vec2 step_ = frame.ring_px * RING[k];
            if (table_inside(fi.first_strip, strips, at + step_.x * dx + step_.y * dy)) {
                ++around;
                border_depth = max(border_depth, gl_FragCoord.z + dot(step_, slope));
            }
        }
        if (around < (hidden ? RING_POINTS : 1u)) discard;
    } else if (hidden) {
        discard;
    }
    visible = uvec2(item + 1u, packUnorm2x16((uv + 1.0) / 3.0));
    gl_FragDepth = inside ? gl_FragCoord.z : min(gl_FragCoord.z, border_depth);
}
