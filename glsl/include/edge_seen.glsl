// Whether a point of an edge is visible: the surface in the pixel is a face of the edge, or lies behind the point.
//
//        own face                  another face                     depth along the axis ─▶
//   ─────────●═══ edge      ──────────────╲  O, visible in the pixel
//      the visible sheet                   ╲
//      contains the edge            edge ● ╲    before O's tangent plane: visible; behind it: hidden
//
// Newton's method follows the exact surface at the pixel's centre to the edge's place in the picture, and compares the
// point with the tangent plane there. No offset is added: another face may be behind by rounding alone. A sheet of an
// own face belongs to the edge if the point is within `slack` of its tangent plane. Where two sheets meet at a fold,
// this moves the end of a line across the fold by a quarter of the slack. Needs placed.glsl, patch.glsl, refine.glsl,
// visible.glsl, edges.glsl, `frame`, buffers `MeshInstance mesh_instances[]`, `uint triangles[]`, `vec3 positions[]`,
// `OperandMesh operand_meshes[]`, `uint operand_triangles[]`, `vec3 operand_positions[]`, `uimage2D operand_uv`,
// `usamplerBuffer leaf_surfaces`, `samplerBuffer surface_places`, functions `bool is_own_face(FaceInstance)` and
// `bool is_own_triangle(uint instance, uint triangle)`, and the constant `OWN_PATCHES_HIDE`: whether patches of own
// faces are compared here, and not in edge_covered.glsl. With SOLIDS_BY_DEPTH, what is named of operands and solids'
// sides is not needed: they are compared by their depth in the picture.
#ifndef EDGE_SEEN_GLSL
#define EDGE_SEEN_GLSL

// Rounding of a point's place, relative to its depth: some eight roundings.
const float POINT_ROUNDING = 1e-6;
// Newton's method has converged.
const float ARRIVED_PX = 0.05;

layout(constant_id = 27) const bool SCENE_HAS_MESHES = false;
layout(constant_id = 17) const bool SOLIDS_HAVE_PATCHES = false;
layout(constant_id = 29) const bool SCENE_HAS_SOLIDS = false;

#include "solids.glsl"
#include "boundary_operands.glsl"
#include "in_picture.glsl"

// A point of an edge: its place in the picture, and relative to the eye (right, down, ahead).
struct EdgePoint {
    vec2 pixel;
    vec3 place;
    vec2 slack; // allowed distance from a sheet of an own face: pixels, and units of the part
};

// Of a homogeneous pixel, or of a direction that moves it.
vec3 seen_from_eye(vec4 q) { return vec3((q.xy - frame.principal_px * q.w) / frame.focal_px, q.z); }

// Distance of the point before the plane through `on` with normal `n`, for either sign of the normal.
float before_plane(vec3 point, vec3 on, vec3 n) {
    vec3 ray = frame.perspective != 0u ? on : vec3(0.0, 0.0, 1.0);
    return -dot(point - on, n) * sign(dot(n, ray)) / length(n);
}

// Allowed distance of an own sheet from the edge: pixels, and units of the part.
float own_slack(vec3 point, View view, vec2 slack) {
    float stretch = 0.0;
    for (int axis = 0; axis < 3; ++axis) {
        vec4 unit = vec4(axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0, 0.0);
        stretch = max(stretch, length(seen_from_eye(to_pixel(view, unit))));
    }
    float pixel = (frame.perspective != 0u ? point.z : 1.0) / frame.focal;
    return slack.x * pixel + slack.y * stretch + POINT_ROUNDING * point.z;
}

// How far the point lies before the tangent plane at a sample of a surface.
float before_sheet(vec3 point, Sample s, View view) {
    vec3 du = seen_from_eye(to_pixel(view, vec4(s.jet.du, 0.0)));
    vec3 dv = seen_from_eye(to_pixel(view, vec4(s.jet.dv, 0.0)));
    return before_plane(point, seen_from_eye(s.q), cross(normalize(du), normalize(dv)));
}

bool is_before_patch(EdgePoint e, uvec2 seen, bool own_hides) {
    uint patch_instance = seen_patch_instance(seen.x);
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Face face = face_at(fi.face);
    Patch patch_ = patch_at(face.first_patch + patch_instance - fi.first_patch_instance);
    View view = view_at(fi.instance);
    Sample s = refine(patch_, view, unpack_uv(seen.y), e.pixel);
    float before = before_sheet(e.place, s, view);
    if (is_own_face(fi)) return !own_hides || !(before < -own_slack(e.place, view, e.slack));
    // the sheet ends before the edge, at a fold; or it has no tangent plane
    if (!(length(s.miss) <= ARRIVED_PX) || isnan(before)) return e.place.z <= s.q.z;
    return before >= -POINT_ROUNDING * e.place.z;
}

bool is_before_mesh(EdgePoint e, uvec2 seen) {
    MeshInstance placed = mesh_instances[seen_mesh_instance(seen.x)];
    View view = view_at(placed.instance);
    vec3 a = positions[triangles[3u * seen.y]];
    vec3 ab = positions[triangles[3u * seen.y + 1u]] - a;
    vec3 ac = positions[triangles[3u * seen.y + 2u]] - a;
    vec3 b = seen_from_eye(to_pixel(view, vec4(ab, 0.0)));
    vec3 c = seen_from_eye(to_pixel(view, vec4(ac, 0.0)));
    vec3 on = seen_from_eye(to_pixel(view, vec4(a, 1.0)));
    float before = before_plane(e.place, on, cross(normalize(b), normalize(c)));
    if (is_own_triangle(placed.instance, seen.y)) return !(before < -own_slack(e.place, view, e.slack));
    return !(before < -POINT_ROUNDING * e.place.z);
}

// Depth of the mesh or solid in a pixel; `none` if its word differs from `like`.
float solid_depth(ivec2 at, uint like, float none) {
    if (!is_in_picture(at)) return none;
    uvec2 seen = imageLoad(visibility, at).xy;
    if (sees_nothing(seen.x)) seen = imageLoad(meshes_and_solids, at).xy;
    return seen.x == like ? uintBitsToFloat(seen.y) : none;
}

#ifndef SOLIDS_BY_DEPTH

// A plane that is a side of a Boolean solid: `plane` is seen from the eye.
bool is_before_side(EdgePoint e, vec4 plane) {
    vec3 p = e.place.x * frame.right - e.place.y * frame.up + e.place.z * frame.forward;
    float towards = frame.perspective != 0u ? -plane.w : -dot(plane.xyz, frame.forward);
    return (dot(plane.xyz, p) - plane.w) * sign(towards) >= -POINT_ROUNDING * e.place.z;
}

#include "triangle_mesh.glsl"

// A triangle of an operand.
bool is_before_operand(EdgePoint e, uint triangle) {
    View view = view_at(mesh_of(triangle).instance);
    vec3 a = operand_positions[operand_triangles[3u * triangle]];
    vec3 ab = operand_positions[operand_triangles[3u * triangle + 1u]] - a;
    vec3 ac = operand_positions[operand_triangles[3u * triangle + 2u]] - a;
    vec3 b = seen_from_eye(to_pixel(view, vec4(ab, 0.0)));
    vec3 c = seen_from_eye(to_pixel(view, vec4(ac, 0.0)));
    float before = before_plane(e.place, seen_from_eye(to_pixel(view, vec4(a, 1.0))), cross(normalize(b), normalize(c)));
    return !(before < -POINT_ROUNDING * e.place.z);
}

#endif

// Other sides of Boolean solids: the side's depth, and its slope from neighbouring pixels with the same side.
bool is_before_solid(EdgePoint e, ivec2 at, uvec2 seen) {
#ifndef SOLIDS_BY_DEPTH
    if (SCENE_HAS_SOLIDS && sees_solid(seen.x) && seen_side(seen.x) < frame.side_count) {
        uint side = side_word(leaf_surfaces, seen_side(seen.x));
        if ((side & SIDE_PLANE) != 0u) return is_before_side(e, place_at(surface_places, side >> SIDE_SHIFT));
    } else if (SCENE_HAS_SOLIDS && sees_solid(seen.x)) {
        return is_before_operand(e, seen_side(seen.x) - frame.side_count);
    }
#endif
    float depth = uintBitsToFloat(seen.y);
    vec2 step_ = e.pixel - (vec2(at) + 0.5);
    // linear in the picture: the depth in a parallel view, else its inverse
    float here = frame.perspective != 0u ? 1.0 / depth : depth;
    float there = here;
    for (uint axis = 0u; axis < 2u; ++axis) {
        ivec2 beside = ivec2(axis == 0u ? 1 : 0, axis == 0u ? 0 : 1);
        float after = solid_depth(at + beside, seen.x, depth);
        float before = solid_depth(at - beside, seen.x, depth);
        bool both = after != depth && before != depth;
        float rise = frame.perspective != 0u ? 1.0 / after - 1.0 / before : after - before;
        there += step_[axis] * rise * (both ? 0.5 : 1.0);
    }
    float follows = frame.perspective != 0u ? 1.0 / max(there, 1e-36) : there;
    return e.place.z <= follows * (1.0 + POINT_ROUNDING);
}

bool is_seen(EdgePoint e, ivec2 at) {
    uvec2 seen = imageLoad(visibility, at).xy;
    if (SCENE_HAS_MESHES_OR_SOLIDS && sees_nothing(seen.x)) seen = imageLoad(meshes_and_solids, at).xy;
    if (sees_nothing(seen.x)) return true;
    if (SCENE_HAS_MESHES && sees_mesh(seen.x)) return is_before_mesh(e, seen);
#ifndef SOLIDS_BY_DEPTH
    if (SOLIDS_HAVE_PATCHES && sees_operand(seen.x)) {
        return is_before_patch(e, uvec2(seen.x, imageLoad(operand_uv, at).x), true);
    }
#endif
    if (sees_other(seen.x)) return is_before_solid(e, at, seen);
    return is_before_patch(e, seen, OWN_PATCHES_HIDE);
}

#endif
