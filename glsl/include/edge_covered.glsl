// Whether a surface that pixels around a point of an edge see covers the point.
//
//      ·   │·       the four centres around E. What hides E reaches over it; where it is wider than a pixel, one of them
//         E│         sees it. The pixel that is asked may see past its outline, or be covered by what ends before E.
//      ·   │·
//          outline
//
// The surface is followed to E's place in the picture, by Newton's method, from patch to patch and over the seam. It
// covers E where it is before it, as edge_seen.glsl has it, and inside its trims. Needs edge_seen.glsl,
// face_point.glsl, trim.glsl, with WITHIN_VOLUME volume.glsl.
#ifndef EDGE_COVERED_GLSL
#define EDGE_COVERED_GLSL

// From a place in the picture that a surface passes: Newton's method halves its way to a fold with each step.
const float COVERS_PX = 0.01;
// How far behind an own sheet the edge may lie: 1/512 px from the fold, where the sheets are four times as far from
// each other's tangent planes; and of what the edge may be off, four times, along the diagonal of three axes.
const float COVERS_OWN_PX = 1.0 / 128.0;
const float COVERS_OWN_OFF = 7.0;

// Of a face that a step leads out of: the patch instance where a closed face goes on, and (u, v) there; false where the
// step does not lead out.
bool over_the_seam(FaceInstance fi, Face face, inout uint patch_instance, inout vec2 uv) {
    ivec2 count = ivec2(face.count_u, face.count_v);
    ivec2 place = place_of(face, int(patch_instance - fi.first_patch_instance));
    ivec2 out_ = way_beyond(uv, BEYOND);
    ivec2 next = (place + out_ + count) % count;
    bvec2 over = notEqual(next, place + out_);
    patch_instance = fi.first_patch_instance + patch_in(face, next) - face.first_patch;
    uv = mix(clamp(uv, 0.0, 1.0), vec2(lessThan(out_, ivec2(0))), over);
    return any(over) && side_of(patch_at(patch_in(face, next)).shape) != SIDE_OUTSIDE;
}

bool patch_covers(EdgePoint e, uvec2 seen) {
    uint patch_instance = seen_patch_instance(seen.x);
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Face face = face_at(fi.face);
    View view = view_at(fi.instance);
    // own sheets are compared where the pixel sees them
    if (OWN_PATCHES_HIDE && is_own_face(fi)) return false;
    vec2 slack = is_own_face(fi) ? vec2(COVERS_OWN_PX, COVERS_OWN_OFF * e.slack.y) : vec2(0.0);
    float behind = own_slack(e.place, view, slack);
    vec2 uv = unpack_uv(seen.y);
    bool covers = false;
    bool goes_on = true;
    for (uint turn = 0u; turn < 2u && goes_on; ++turn) {
        Sample s = refine_across(fi, face, view, patch_instance, uv, e.pixel);
        covers = length(s.miss) <= COVERS_PX && before_sheet(e.place, s, view) < -behind;
#ifdef TRIM_BY_UNTRIMMED
        covers = covers && (face.flags & FACE_TRIMMED) == 0u; // a way without a test here
#endif
        Patch patch_ = patch_at(face.first_patch + patch_instance - fi.first_patch_instance);
        if (covers) covers = is_there(fi, face, patch_instance, patch_, s.uv);
#ifdef WITHIN_VOLUME
        if (covers) covers = in_volume(s.q, ON_PX);
#endif
        uv = s.uv;
        goes_on = !covers && over_the_seam(fi, face, patch_instance, uv);
    }
    return covers;
}

bool triangle_covers(EdgePoint e, uvec2 seen) {
    MeshInstance placed = mesh_instances[seen_mesh_instance(seen.x)];
    View view = view_at(placed.instance);
    mat3 corners;
    for (uint k = 0u; k < 3u; ++k) {
        corners[k] = to_pixel(view, vec4(positions[triangles[3u * seen.y + k]], 1.0)).xyw;
    }
    // shares of the corners; of none, where it is seen edge-on, they are no numbers
    vec3 shares = inverse(corners) * vec3(e.pixel, 1.0);
    return all(greaterThanEqual(shares, vec3(0.0))) && !is_before_mesh(e, seen);
}

// Whether something that the pixel `at` or a centre around the point sees covers the point.
bool is_covered(EdgePoint e, ivec2 at) {
    ivec2 first = ivec2(floor(e.pixel - 0.5));
    bool covered = false; // tested by the loop's condition, not by a `break`: see refine.glsl
    for (int k = 0; k < 5 && !covered; ++k) {
        ivec2 around = k == 4 ? at : first + ivec2(k & 1, k >> 1);
        bool is_read = is_in_picture(around) && (k == 4 || around != at);
        uvec2 seen = uvec2(0u);
        if (is_read) seen = imageLoad(visibility, around).xy;
        if (SCENE_HAS_MESHES_OR_SOLIDS && is_read && sees_nothing(seen.x)) {
            seen = imageLoad(meshes_and_solids, around).xy;
        }
#ifndef SOLIDS_BY_DEPTH
        bool operand = SOLIDS_HAVE_PATCHES && sees_operand(seen.x);
        if (operand) seen.y = imageLoad(operand_uv, around).x;
#else
        const bool operand = false;
#endif
        if (!sees_nothing(seen.x) && (operand || !sees_other(seen.x))) covered = patch_covers(e, seen);
        else if (SCENE_HAS_MESHES && sees_mesh(seen.x)) covered = triangle_covers(e, seen);
    }
    return covered;
}

#endif
