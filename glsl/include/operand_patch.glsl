// Pass `operand_patch`: crossings of rays with spline faces of operands, found by the tessellation of pass
// `visibility`. The depth is that of the exact surface at the pixel's centre.
//
// Faces that meet along an edge are trimmed separately, so a ray may pass between them. The skirt around each trimmed
// face gives fragments of its own. Pass `operand_sort` uses them if a ray would otherwise leave without having entered,
// or enter without leaving. The entry point defines TRIMMED and its way to trim.
#include "scene.glsl"
#include "view.glsl"
#include "boundary_operands.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 10) buffer FragmentCounts { uint fragment_counts[]; };
layout(scalar, binding = 11) readonly buffer FragmentStarts { uint fragment_starts[]; };
layout(scalar, binding = 12) writeonly buffer Fragments { Fragment fragments[]; };

#ifdef TRIMMED
#define TRIM_BINDING 13
#include "trim.glsl"
#endif
#include "facing.glsl"
#define INSTANCES_BINDING 9
#include "placed.glsl"
#include "patch.glsl"
#include "put_fragment.glsl"
#include "refine.glsl"
#include "gap_radius.glsl"
#include "visible.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint patch_instance;

void main() {
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Face face = face_at(fi.face);
    Patch patch_ = patch_at(face.first_patch + patch_instance - fi.first_patch_instance);
    Instance instance = instance_at(fi.instance);
    vec2 dx = dFdx(uv) * patch_.domain.zw;
    vec2 dy = dFdy(uv) * patch_.domain.zw;
    uint operand = instance.operand | FRAGMENT_PATCH;
    if (looks_away(dx, dy, face, instance)) operand |= FRAGMENT_LEAVES;
#ifdef TRIMMED
    vec2 at = patch_.domain.xy + uv * patch_.domain.zw;
    vec2 around = frame.gap_radius_px * (abs(dx) + abs(dy)); // the point's circle is in this box
    uint area = trim_area(fi, face, at - around, at + around);
    if (area == TRIM_OUT) discard;
    bool inside = area == TRIM_IN || trim_inside(fi, face, at);
    bool near = inside;
    for (uint k = 0u; area == TRIM_MIXED && !near && k < DIRECTION_COUNT; ++k) {
        vec2 step_ = frame.gap_radius_px * DIRECTIONS[k];
        near = trim_inside(fi, face, at + step_.x * dx + step_.y * dy);
    }
    if (!near) discard;
    if (!inside) operand |= FRAGMENT_SKIRT;
#endif
    Fragment f = Fragment(operand, 0.0, patch_instance + 1u, 0u);
    if (FILLS) {
        Sample s = refine(patch_, view_at(fi.instance), uv, gl_FragCoord.xy);
        f.depth = s.q.z;
        f.uv = pack_uv(clamp(s.uv, vec2(-1.0), vec2(2.0)));
    }
    put_fragment(f);
}
