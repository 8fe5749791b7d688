// What a pixel sees of a Boolean solid, followed to other places of the picture. face_sheet.glsl has the sheets of
// faces and meshes that are of no solid. Needs scene.glsl, view.glsl, solids.glsl, boundary_operands.glsl,
// eye_ray.glsl, sides.glsl, refine.glsl, visible.glsl, `frame`, and what sides.glsl and patch.glsl need.
//
//        pixel        place                       a side with an equation: the same root of the ray through the place
//   ───────┼────────────┼───                      triangles, spline faces: the tangent plane, which over a pixel or two
//    ╲     │ t          │ depth ?                 is off by what the face bends
//     ╲────●────────────○── sheet
#ifndef SOLID_SHEET_GLSL
#define SOLID_SHEET_GLSL

layout(constant_id = 17) const bool SOLIDS_HAVE_PATCHES = false;

// In the place of a side's surface: a spline face of an operand.
const uint SPLINE_SHEET = 0xc0000000u;
const uint NO_LEAF = 0xffffffffu;

struct Sheet {
    bool is_there;  // something is seen
    bool is_round;  // has an equation beside its tangent plane
    uint surface;   // as Side.surface; of a spline face SPLINE_SHEET
    uint leaf;
    uint operand;     // of an operand without equations its number + 1
    vec4 plane;     // n . p = w at the point that is seen: model axes, from the eye
    float t;        // its depth
    bool enters;    // rays get to where the surface's function is below 0
    vec2 range;     // depths nearer to this root than to another one of the same kind
    uvec2 face;     // of a face or mesh that is of no solid: the pixel's words; else 0
};

const Sheet NO_SHEET = Sheet(false, false, 0u, 0u, 0u, vec4(0.0), 0.0, false, vec2(0.0), uvec2(0u));

bool is_depth(float t) { return abs(t) < 0.1 * NEVER; }

// Where the ray meets the surface from outside, or from inside: at most twice.
vec2 roots_of(uint surface, bool enters, Ray ray) {
    Span s = surface_span(surface_at(surfaces, surface), ray.o - place_at(surface_places, surface).xyz, ray.d);
    if (!(s.lo < s.hi)) return vec2(NEVER);
    bool gap = s.g0 < s.g1;
    return enters ? vec2(s.lo, gap ? s.g1 : NEVER) : vec2(s.hi, gap ? s.g0 : NEVER);
}

// Unit normal of the sheet at p, whichever way.
vec3 normal_on(Sheet s, vec3 p) {
    if (!s.is_round) return s.plane.xyz;
    return normalize(surface_gradient(surface_at(surfaces, s.surface), p - place_at(surface_places, s.surface).xyz));
}

// The point of a spline face at a pixel.
struct PatchPoint {
    vec3 n;       // normal, model axes
    uint operand; // that the face bounds
    float t;      // depth
    float miss;   // distance from the pixel, pixels
};

PatchPoint patch_point(uint patch_instance, vec2 uv, vec2 pixel) {
    FaceInstance fi = face_instances[patch_instances[patch_instance]];
    Patch patch_ = patch_at(faces[fi.face].first_patch + patch_instance - fi.first_patch_instance);
    Sample s = refine(patch_, views[fi.instance], uv, pixel);
    vec3 n = normalize(instances[fi.instance].normal * cross(normalize(s.jet.du), normalize(s.jet.dv)));
    return PatchPoint(n, instances[fi.instance].operand, s.q.z, length(s.miss));
}

// `seen` and `uv` are those of the pixel.
Sheet sheet_at(ivec2 at, uvec2 seen, uint uv) {
    Sheet s = NO_SHEET;
    bool of_patch = SOLIDS_HAVE_PATCHES && sees_operand(seen.x);
    if (!of_patch && !sees_solid(seen.x)) return s;
    vec2 pixel = vec2(at) + 0.5;
    Ray ray = eye_ray(frame, pixel);
    s.is_there = true;
    s.t = uintBitsToFloat(seen.y);
    vec3 p = ray.o + s.t * ray.d;
    vec3 n;
    if (of_patch) {
        PatchPoint on = patch_point(seen_patch_instance(seen.x), unpack_uv(uv), pixel);
        n = on.n;
        s.surface = SPLINE_SHEET;
        s.leaf = NO_LEAF;
        s.operand = on.operand + 1u;
    } else {
        Side side = side_at(seen_side(seen.x), s.t, ray);
        n = normalize(side.n);
        s.surface = side.surface;
        s.leaf = side.leaf;
        if ((leaves[side.leaf].flags & LEAF_BOUNDARY) != 0u) s.operand = leaves[side.leaf].first + 1u;
        bool is_plane = s.operand != 0u || (leaf_surface_at(leaf_surfaces, seen_side(seen.x)).surface & SIDE_PLANE) != 0u;
        s.is_round = SOLIDS_HAVE != SURFACE_PLANE && !is_plane;
    }
    s.plane = vec4(n, dot(n, p));
    if (s.is_round) {
        s.enters = dot(n, ray.d) < 0.0;
        vec2 roots = roots_of(s.surface, s.enters, ray);
        float middle = 0.5 * (roots.x + roots.y);
        bool both = is_depth(roots.x) && is_depth(roots.y);
        s.range = vec2(-NEVER, NEVER);
        if (both && s.t < middle) s.range.y = middle;
        if (both && s.t >= middle) s.range.x = middle;
    }
    return s;
}

// Of the sheet where the ray through a place meets it, NEVER where it folds before it gets there.
float depth_on(Sheet s, vec2 place) {
    Ray ray = eye_ray(frame, place);
    float t = plane_depth(s.plane, ray.o, ray.d);
    if (!s.is_round) return is_depth(t) && (frame.perspective == 0u || t > 0.0) ? t : NEVER;
    vec2 roots = roots_of(s.surface, s.enters, ray);
    float nearest = NEVER;
    for (uint k = 0u; k < 2u; ++k) {
        float root = roots[k];
        bool within = is_depth(root) && root >= s.range.x && root <= s.range.y;
        if (within && abs(root - s.t) < abs(nearest - s.t)) nearest = root;
    }
    return nearest;
}

#endif
