// The exact surface under a pixel that shows a patch, then light. Needs placed.glsl, patch.glsl, view.glsl and
// resolved.glsl.
#ifndef RESOLVED_PATCH_GLSL
#define RESOLVED_PATCH_GLSL

#include "refine.glsl"
#include "patch_normal.glsl"
#include "bend.glsl"
#include "visible.glsl"

// `seen` is patch instance + 1 and packed (u, v). An operand's face may show its back, which is then a front of the
// solid.
void write_patch(uvec2 seen, bool operand) {
    uint patch_instance = seen_patch_instance(seen.x);
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Face face = face_at(fi.face);
    Instance instance = instance_at(fi.instance);
    View view = view_at(fi.instance);
    Patch patch_;
    vec3 n;
    uint number = patch_instance - fi.first_patch_instance;
    Sample s = surface_under(face, number, view, unpack_uv(seen.y), gl_FragCoord.xy, patch_, n);
    n = normalize(instance.normal * n);
    bool flip = ((face.flags & FACE_SAME_SENSE) == 0u) != (instance.mirrored != 0u);
    if (operand) flip = dot(n, eye_ray(frame, gl_FragCoord.xy).d) > 0.0;
    if (flip) n = -n;
    vec2 at = patch_.domain.xy + s.uv * patch_.domain.zw;
    bool solid = (face.flags & FACE_SOLID) != 0u;
    vec2 own = face.domain.xy + at * face.domain.zw;
    Curvature curvature = NO_CURVATURE;
    if (shows_curvature()) {
        curvature = patch_curvature(patch_, view, s);
        if (flip) curvature.mean = -curvature.mean;
    }
    write_surface(face.colour, instance, n, solid, s.q.z, face.id, own, NO_SURFACE, curvature);
}

#endif
