// Pass `visibility`, patches without a trim test: writes the patch instance and (u, v). A solid's face that shows its
// back is a gap candidate, as in visibility_trimmed.glsl. If a volume trims the scene (WITHIN_VOLUME), the exact point
// at (u, v) must be within it.
#include "scene.glsl"
#include "view.glsl"
#define INSTANCES_BINDING 9
#include "placed.glsl"
#include "facing.glsl"
#include "visible.glsl"

#ifdef WITHIN_VOLUME
layout(scalar, binding = 0) uniform Frames { Frame frame; };
#define VOLUME_BINDING 10
#include "exact_point.glsl"
#endif

layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint patch_instance;
layout(location = 0) out uvec2 visible;

void main() {
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Face face = face_at(fi.face);
    bool solid = (face.flags & FACE_SOLID) != 0u;
    bool candidate = solid && looks_away(dFdx(uv), dFdy(uv), face, instance_at(fi.instance));
#ifdef WITHIN_VOLUME
    Patch patch_ = patch_at(face.first_patch + patch_instance - fi.first_patch_instance);
    if (!in_volume(exact_point(patch_, view_at(fi.instance), uv), ON_PX)) discard;
#endif
    visible = uvec2(patch_instance + 1u | (candidate ? GAP_CANDIDATE : 0u), pack_uv(uv));
}
