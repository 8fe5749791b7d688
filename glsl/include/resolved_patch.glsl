// The exact surface under a pixel that sees a patch, then light. Needs the scene's buffers, patch.glsl,
// view.glsl and resolved.glsl.
#ifndef RESOLVED_PATCH_GLSL
#define RESOLVED_PATCH_GLSL

#include "refine.glsl"
#include "visible.glsl"

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

// `seen` are item + 1 and packed (u, v). The other side of an operand's face may be seen, and is a front
// of the solid.
void write_patch(uvec2 seen, bool operand) {
    uint item = seen_item(seen.x);
    FaceInstance fi = face_instances[item_face_instance[item]];
    Face face = faces[fi.face];
    Patch patch_ = patches[face.first_patch + item - fi.first_item];
    Instance instance = instances[fi.instance];
    View view = views[fi.instance];
    Sample s = refine(patch_, view, unpack_uv(seen.y), gl_FragCoord.xy);
    vec3 n = normalize(instance.normal * normal_of(patch_, s.jet, s.uv));
    bool flip = ((face.flags & FACE_SAME_SENSE) == 0u) != (instance.mirrored != 0u);
    if (operand) flip = dot(n, eye_ray(frame, gl_FragCoord.xy).d) > 0.0;
    if (flip) n = -n;
    vec2 at = patch_.domain.xy + s.uv * patch_.domain.zw;
    bool solid = (face.flags & FACE_SOLID) != 0u;
    vec2 own = face.domain.xy + at * face.domain.zw;
    write_surface(face.colour, instance, n, solid, s.q.z, face.id, own, NO_SURFACE);
}

#endif
