// What a pixel sees of a face or mesh that is of no Boolean solid, followed to other places of the picture, and where a
// solid meets it. Needs solid_sheet.glsl, solid_change.glsl, and buffers `MeshInstance mesh_instances[]`,
// `uint mesh_triangles[]`, `vec3 mesh_positions[]`.
//
//   pixel ·  · place      the tangent plane at the pixel meets the solid at a place; the face is followed to it by
//       ───╲──╱           Newton's method, and its plane there meets the solid closer to where the face does
//           ╲╱ solid
#ifndef FACE_SHEET_GLSL
#define FACE_SHEET_GLSL

layout(constant_id = 27) const bool SCENE_HAS_MESHES = false;
// Some faces are of no Boolean solid.
layout(constant_id = 46) const bool SCENE_HAS_FACES = false;

// Planes of a face that are tried: each squares the distance from the meeting, less than a pixel at first.
const uint FACE_PLANES = 3u;
// So far from a place a point of a face is at it: pixels.
const float FACE_AT_PX = 0.05;
// A triangle whose normal has a smaller cosine with the ray meets nothing beyond its sides: there the mesh ends or
// turns away. Beside the outline of a mesh whose triangles turn by 20 degrees it is less than the sine of that.
const float FACING = 0.35;
// Rounding of shares of a triangle's corners.
const float SHARE_ROUNDING = 1e-3;

bool sees_face(uint word) {
    return SCENE_HAS_FACES && !sees_nothing(word) && !sees_other(word) || SCENE_HAS_MESHES && sees_mesh(word);
}

// Model axes, relative to the eye, of a homogeneous pixel or a direction that moves it.
vec3 from_eye(vec4 q) {
    vec2 across = (q.xy - frame.principal_px * q.w) / frame.focal_px;
    return across.x * frame.right - across.y * frame.up + q.z * frame.forward;
}

mat3 corners_from_eye(uvec2 seen) {
    View view = views[mesh_instances[seen_mesh_instance(seen.x)].instance];
    mat3 corners;
    for (uint k = 0u; k < 3u; ++k) {
        corners[k] = from_eye(to_pixel(view, vec4(mesh_positions[mesh_triangles[3u * seen.y + k]], 1.0)));
    }
    return corners;
}

// Of a pixel's words that name a face or mesh.
Sheet face_sheet(ivec2 at, uvec2 seen) {
    vec2 pixel = vec2(at) + 0.5;
    Ray ray = eye_ray(frame, pixel);
    Sheet s = NO_SHEET;
    s.is_there = true;
    s.surface = SPLINE_SHEET;
    s.leaf = NO_LEAF;
    s.face = seen;
    if (SCENE_HAS_MESHES && sees_mesh(seen.x)) {
        mat3 corners = corners_from_eye(seen);
        vec3 ab = corners[1] - corners[0];
        vec3 ac = corners[2] - corners[0];
        vec3 n = normalize(cross(normalize(ab), normalize(ac)));
        s.plane = vec4(n, dot(n, corners[0]));
        s.t = plane_depth(s.plane, ray.o, ray.d);
    } else {
        PatchPoint on = patch_point(seen_patch_instance(seen.x), unpack_uv(seen.y), pixel);
        s.t = on.t;
        s.plane = vec4(on.n, dot(on.n, ray.o + on.t * ray.d));
    }
    return s;
}

// Whether a triangle reaches a place, or goes on beyond its sides as far as planes can tell.
bool triangle_reaches(Sheet s, vec2 place) {
    Ray ray = eye_ray(frame, place);
    bool faces_eye = abs(dot(s.plane.xyz, normalize(ray.d))) >= FACING;
    vec3 p = ray.o + depth_on(s, place) * ray.d;
    mat3 corners = corners_from_eye(s.face);
    vec3 shares;
    for (uint k = 0u; k < 3u; ++k) {
        vec3 a = corners[(k + 1u) % 3u];
        shares[k] = dot(cross(a - p, corners[(k + 2u) % 3u] - p), s.plane.xyz);
    }
    float rounding = SHARE_ROUNDING * (abs(shares.x) + abs(shares.y) + abs(shares.z));
    bool is_within = all(greaterThanEqual(shares, vec3(-rounding)));
    return faces_eye || is_within;
}

// Follows the face to a place: false where it does not get there. `moved`: by how many pixels' width its plane there is
// off the plane before.
bool follow_face(inout Sheet s, vec2 place, out float moved) {
    moved = 0.0;
    if (SCENE_HAS_MESHES && sees_mesh(s.face.x)) return triangle_reaches(s, place);
    PatchPoint on = patch_point(seen_patch_instance(s.face.x), unpack_uv(s.face.y), place);
    Ray ray = eye_ray(frame, place);
    moved = abs(depth_on(s, place) - on.t) / pixel_across(on.t);
    s.plane = vec4(on.n, dot(on.n, ray.o + on.t * ray.d));
    return on.miss <= FACE_AT_PX;
}

// Between a solid and a face: as change_between, where both meet by the face itself. CHANGE_NONE where they do not, for
// then the face ends or turns away before, and has lines of its own.
Change change_beside_face(Sheet sheets[2], vec2 a, vec2 b, float order) {
    uint face = sheets[0].face != uvec2(0u) ? 0u : 1u;
    Change c;
    bool follows = true;
    for (uint i = 0u; i < FACE_PLANES && follows; ++i) {
        c = change_between(sheets, a, b, order);
        follows = c.why == CHANGE_MEET;
        // a face that lies flush on a solid has no line there
        if (c.why == CHANGE_SMOOTH) c.why = CHANGE_NONE;
        if (!follows) continue;
        float moved;
        bool there = follow_face(sheets[face], mix(a, b, c.share), moved);
        if (!there || c.cosine >= SMOOTH_COSINE) c.why = CHANGE_NONE;
        follows = there && moved > MET_PX;
    }
    return c;
}

#endif
