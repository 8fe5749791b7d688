#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `visibility`, patches without a trim test: who is seen, and where on its patch. A face of a
// solid that is seen from behind is doubtful, as in visibility_trimmed.glsl.
#include "scene.glsl"
#include "facing.glsl"
#include "visible.glsl"

layout(scalar, binding = 2) readonly buffer FaceInstances { FaceInstance face_instances[]; };
layout(scalar, binding = 3) readonly buffer Faces { Face faces[]; };
layout(scalar, binding = 5) readonly buffer Items { uint item_face_instance[]; };
layout(scalar, binding = 9) readonly buffer Instances { Instance instances[]; };

layout(location = 0) in vec2 uv;
layout(location = 1) flat in uint item;
layout(location = 0) out uvec2 visible;

void main() {
    FaceInstance fi = face_instances[item_face_instance[item]];
    Face face = faces[fi.face];
    bool solid = (face.flags & FACE_SOLID) != 0u;
    bool doubtful = solid && looks_away(dFdx(uv), dFdy(uv), face, instances[fi.instance]);
    visible = uvec2(item + 1u | (doubtful ? DOUBTFUL : 0u), pack_uv(uv));
}
