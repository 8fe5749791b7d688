// Pass `edge_fold`: outlines of curved faces, where the surface folds away from the eye: normal across the ray.
//
//      pixel ·      ╭─── the exact fold: cosine between normal and ray = 0
//           ╲╲     ╱
//            ╲ ╲  ╱      from where a pixel beside this one sees the face, Newton's method to the point of the fold
//      face    ╲╱        that is nearest to this pixel's centre
//
// Only pixels are looked at beside which something else is seen: another face, or another place of the face. The fold
// is the exact surface's, within ARRIVED_PX. It counts when it is as near to the pixel that sees the face as pixels
// beside each other are, and inside the face's trims: where the face ends before it folds, its edge is the outline. What
// another face covers, as edge_covered.glsl has it, is not drawn: surfaces that pass through each other have no edge that
// would end the fold. The trim test is that of one way (trim.glsl).
#include "scene.glsl"
#include "view.glsl"
#include "edges.glsl"
#include "boundary_operands.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 7, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 8, rg32ui) readonly uniform uimage2D meshes_and_solids; // in scenes without trims the same
layout(binding = 9, r32ui) uniform uimage2D lines;
// in scenes without meshes not read
layout(scalar, binding = 10) readonly buffer MeshInstances { MeshInstance mesh_instances[]; };
layout(scalar, binding = 11) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 12) readonly buffer Positions { vec3 positions[]; };

// in scenes without Boolean solids not read
layout(binding = 13, r32ui) readonly uniform uimage2D operand_uv;
layout(binding = 14) uniform usamplerBuffer leaf_surfaces;
layout(binding = 15) uniform samplerBuffer surface_places;
layout(scalar, binding = 16) readonly buffer OperandMeshes { OperandMesh operand_meshes[]; };
layout(scalar, binding = 17) readonly buffer OperandTriangles { uint operand_triangles[]; };
layout(scalar, binding = 18) readonly buffer OperandPositions { vec3 operand_positions[]; };

layout(scalar, push_constant) uniform Push {
    float half_px;
    uint capacity; // of the list of items
} push;

#define LISTS_BINDING 19
#include "line_items.glsl"
#define TRIM_BINDING 20
#include "trim.glsl"
#include "placed.glsl"
#include "patch.glsl"
#include "patch_place.glsl"
#include "refine.glsl"
#include "face_point.glsl"
#include "visible.glsl"

// Of the face whose fold is looked at.
FaceInstance own_face;

bool is_own_face(FaceInstance fi) { return fi == own_face; }

bool is_own_triangle(uint instance, uint triangle) { return false; }

const bool OWN_PATCHES_HIDE = true;
#include "edge_seen.glsl"
#include "edge_covered.glsl"
#include "fold.glsl"
#include "fold_beside.glsl"

// Whether a face reaches a fold, of its domain or beyond a seam, where a pixel beside it sees the face at (u, v) of a
// patch. Beyond a window of a deep zoom the trims are those at its side.
bool reaches(FaceInstance fi, Face face, uint patch_instance, Patch patch_, vec2 fold, vec2 uv) {
    vec2 place = mix(fold, patch_.domain.xy + uv * patch_.domain.zw, BEFORE_FOLD);
    bvec2 meets = notEqual(face.flags & uvec2(FACE_MEETS_U, FACE_MEETS_V), uvec2(0u));
    vec2 turns = mix(vec2(0.0), floor(place), meets);
    place -= turns;
    place = mix(place, max(place, 0.0), goes_on_before(face));
    place = mix(place, min(place, 1.0), goes_on_after(face));
    if (clamp(place, 0.0, 1.0) != place) return false;
    if ((face.flags & FACE_TRIMMED) == 0u) return true;
#ifdef TRIM_BY_TABLE
    // the table has rows only where the picture shows a patch that a trim curve crosses
    if (!table_covers(fi.first_bin, face.strips, place)) {
        vec2 there = (place + turns - patch_.domain.xy) / patch_.domain.zw;
        return in_whole_patch(fi, face, patch_instance, there, meets);
    }
#endif
    return trim_inside(fi, face, place);
}

// Looks for the fold beside a pixel from where the pixel `around` sees the face.
void look(uvec2 item) {
    ivec2 at = line_pixel(item.x);
    ivec2 around = beside_pixel(at, item.y);
    uvec2 found = patch_seen(around);
    if (found.x == 0u) return; // a driver's idle lanes
    uint patch_instance = found.x - 1u;
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Face face = face_at(fi.face);
    Patch patch_ = patch_at(face.first_patch + patch_instance - fi.first_patch_instance);
    View view = view_at(fi.instance);
    Sample s;
    vec2 at_fold;
    int n = int(patch_instance - fi.first_patch_instance);
    vec2 uv = unpack_uv(found.y);
    if (!find_fold(face, n, view, uv, vec2(at) + 0.5, s, at_fold)) return;
    vec2 place = s.q.xy / s.q.w;
    float covered = line_coverage(length(s.miss), push.half_px);
    uint steps = uint(covered * LINE_STEPS + 0.5);
    if (steps == 0u || distance(place, vec2(around) + 0.5) > FOLD_REACH_PX) return;
    if (!reaches(fi, face, patch_instance, patch_, at_fold, uv)) return;
    put_found(Found(item.x, patch_instance, steps, place, seen_from_eye(s.q), 0.0));
}

void main() {
    uint i = thread_number();
    if (i >= items_of_step()) return;
    if (LINE_STEP == STEP_LOOK) {
        look(item_at(i));
        return;
    }
    Found f = found_at(i);
    ivec2 at = line_pixel(f.pixel);
    uint best = LINE_SEEN | f.steps << LINE_COVERAGE | LINE_FOLD;
    own_face = face_instance_at(face_instance_of(f.what));
    EdgePoint e = EdgePoint(f.place, f.from_eye, vec2(FOLD_SHEET_PX, 0.0));
    if (imageLoad(lines, at).x >= best || !is_seen(e, at) || is_covered(e, at)) return;
    imageAtomicMax(lines, at, best);
}
