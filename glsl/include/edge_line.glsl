// Pass `edge_line`: each pixel's best line. Where several cover it, the one that is seen, then the one that covers most
// of it, then the last one counts: the same whatever the order of the lists.
//
//    ●━━━━━━━━━━━━●   chord        distance of the pixel's centre ─▶ share of the pixel
//        │            its point nearest to the centre ─▶ parameter ─▶ the exact point of the edge ─▶ seen, or hidden
//        · pixel
//
// This pass also draws the folds of curved faces beside their smooth edges and seams. Pass `edge_fold` draws the folds
// of faces that a pixel's centre sees. The trim test is that of one way (trim.glsl).
#include "scene.glsl"
#include "view.glsl"
#include "edges.glsl"
#include "boundary_operands.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 7, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 8, rg32ui) readonly uniform uimage2D meshes_and_solids; // in scenes without trims the same
layout(binding = 9) uniform usamplerBuffer face_keys;    // a word a face of the scene
layout(binding = 10) uniform usamplerBuffer sources;      // of an instance of the scene: part and instance, from 1 on
layout(scalar, binding = 11) readonly buffer Chords { Chord chords[]; };
layout(scalar, binding = 12) readonly buffer PieceInstances { PieceInstance piece_instances[]; };
layout(scalar, binding = 13) readonly buffer EdgePieces { EdgePiece edge_pieces[]; };
layout(scalar, binding = 14) readonly buffer EdgeLines { EdgeLine edge_lines[]; };
layout(scalar, binding = 15) readonly buffer OwnFaces { uint own_faces[]; };
layout(binding = 16) uniform samplerBuffer edge_points;
layout(binding = 17, r32ui) uniform uimage2D lines;
// in scenes without meshes not read
layout(scalar, binding = 18) readonly buffer MeshInstances { MeshInstance mesh_instances[]; };
layout(scalar, binding = 19) readonly buffer Triangles { uint triangles[]; };
layout(scalar, binding = 20) readonly buffer Positions { vec3 positions[]; };

layout(scalar, push_constant) uniform Push {
    vec3 half_px; // of lines: full, thin, bold
    uint hidden;  // 1: hidden ones are drawn, too
    uint capacity; // of the list of items
} push;

#define LISTS_BINDING 21
#include "line_items.glsl"

// descriptors are few: with the trim table, all 32 that every device has
#ifdef WITHIN_VOLUME
#define SOLIDS_BY_DEPTH
#define TRIM_BINDING 22
#else
#define TRIM_BINDING 28
// in scenes without Boolean solids not read
layout(binding = 22, r32ui) readonly uniform uimage2D operand_uv;
layout(binding = 23) uniform usamplerBuffer leaf_surfaces;
layout(binding = 24) uniform samplerBuffer surface_places;
layout(scalar, binding = 25) readonly buffer OperandMeshes { OperandMesh operand_meshes[]; };
layout(scalar, binding = 26) readonly buffer OperandTriangles { uint operand_triangles[]; };
layout(scalar, binding = 27) readonly buffer OperandPositions { vec3 operand_positions[]; };
#endif

#include "trim.glsl"
#ifdef WITHIN_VOLUME
#define VOLUME_BINDING (TRIM_BINDING + TRIM_BUFFERS)
#include "volume.glsl"
#endif
#include "placed.glsl"
#include "patch.glsl"
#include "patch_place.glsl"
#include "refine.glsl"
#include "face_point.glsl"
#include "visible.glsl"

// Of the thread's item.
uint chord;
vec2 centre; // of the pixel

bool is_own_key(uint key) {
    EdgeLine line = edge_lines[edge_pieces[piece_instances[chords[chord].piece_instance].piece].edge];
    bool found = false;
    for (uint i = 0u; i < line.own_count && !found; ++i) found = own_faces[line.first_own + i] == key;
    return found;
}

bool is_own(uint instance, uint key) {
    uint own = piece_instances[chords[chord].piece_instance].instance;
    return is_own_key(key) && texelFetch(sources, int(instance)).y == own;
}

bool is_own_face(FaceInstance fi) { return is_own(fi.instance, word_at(face_keys, fi.face)); }

// Outlines of a mesh have no triangles of their own: all of the instance are, within TURN_SHEET_PX.
bool is_own_triangle(uint instance, uint triangle) {
    if ((chords[chord].style & EDGE_TURNS) == 0u) return is_own(instance, OWN_TRIANGLE | triangle);
    return texelFetch(sources, int(instance)).y == piece_instances[chords[chord].piece_instance].instance;
}

const bool OWN_PATCHES_HIDE = false;
#include "edge_seen.glsl"
#include "edge_covered.glsl"
#include "fold.glsl"
#include "line_seed.glsl"

// Of a piece: single precision.
const float SEED_ROUNDED = 1e-4;
// From the edge to the fold on the surface: so far from it the edge's own trim curve, which is right to half a pixel,
// does not decide.
const float TRIMS_TELL_PX = 1.0;

// What Newton's method leaves of the way to the edge's place, and what the sheet bends on it.
const float ON_SHEET_PX = 1.0 / 64.0;
// An outline of a mesh lies behind the planes of the triangles beside it, by no more than it is away from them in the
// picture where the mesh is round. Those that pixels of the line see are this near.
const float TURN_SHEET_PX = 2.0;
// Dashes of hidden lines and the gaps between them, in half widths of lines.
const float DASH = 8.0;
const float GAP = 6.0;

// The exact point of the edge.
EdgePoint point_at(float t, EdgePiece piece, View view) {
    uint n = piece.degree;
    float rest = 1.0 - t;
    vec4 p = vec4(0.0);
    Weights w = Weights(1.0, 1.0);
    for (uint i = 0u; i <= n; ++i) {
        p = p * rest + texelFetch(edge_points, int(piece.first + i)) * weight_of(w);
        advance(w, n, i, t);
    }
    vec4 q = to_pixel(view, vec4(p.xyz / p.w, 1.0));
    bool turns = (edge_lines[piece.edge].style & EDGE_TURNS) != 0u;
    vec2 slack = vec2(turns ? TURN_SHEET_PX : ON_SHEET_PX, edge_lines[piece.edge].off);
    return EdgePoint(q.xy / q.w, seen_from_eye(q), slack);
}

// Share of a hidden line's dash at a pixel, by rows of a steep line and columns of a flat one.
float dash(vec2 along, vec2 pixel, float half_px) {
    float at = abs(along.x) > abs(along.y) ? pixel.x : pixel.y;
    float period = (DASH + GAP) * half_px;
    float inside = abs(mod(at, period) - 0.5 * DASH * half_px);
    return clamp(0.5 * DASH * half_px - inside + 0.5, 0.0, 1.0);
}

// Some pixel around the point sees a face of the edge that bounds an operand.
bool is_near_own(EdgePoint e) {
    bool near = false;
    for (int k = 0; k < 9 && !near; ++k) {
        ivec2 at = clamp(ivec2(floor(e.pixel)) + ivec2(k % 3 - 1, k / 3 - 1), ivec2(0), ivec2(frame.size) - 1);
        uint seen = imageLoad(visibility, at).x;
        if (sees_nothing(seen)) seen = imageLoad(meshes_and_solids, at).x;
        if (SOLIDS_HAVE_PATCHES && sees_operand(seen)) {
            near = is_own_face(face_instance_at(face_instance_of(seen_patch_instance(seen))));
        } else if (sees_solid(seen) && seen_side(seen) >= frame.side_count) {
            near = is_own_key(OWN_TRIANGLE | seen_side(seen) - frame.side_count);
        }
    }
    return near;
}

// Whether the trims of a placed face leave a place of its domain, in scenes that tell: the table is known of faces that
// a pixel around sees, and has rows only where the picture shows a patch that a trim curve crosses.
bool is_left(uint number, Face face, uint instance, vec2 place) {
    if ((face.flags & FACE_TRIMMED) == 0u) return true;
    FaceInstance fi = FaceInstance(number, instance, 0u, 0u, 0u, 0u, uvec2(0u));
#ifdef TRIM_BY_TABLE
    bool found = false;
    for (int k = 0; k < 9 && !found; ++k) {
        ivec2 at = ivec2(centre) + ivec2(k % 3 - 1, k / 3 - 1);
        uint seen = imageLoad(visibility, clamp(at, ivec2(0), ivec2(frame.size) - 1)).x;
        if (sees_nothing(seen) || sees_other(seen)) continue;
        FaceInstance there = face_instance_at(face_instance_of(seen_patch_instance(seen)));
        found = there.face == number && there.instance == instance;
        if (found) fi = there;
    }
    if (!found || !table_covers(fi.first_bin, face.strips, place)) return true;
#endif
    return trim_inside(fi, face, place);
}

// The fold of a curved face so close to the smooth edge or seam `e` that no pixel's centre may see the face between
// them: the share of the pixel that its line covers, and its point next to the pixel.
float fold_beside(vec4 face_beside, vec4 ends, float t, EdgePoint e, uint instance, out EdgePoint point) {
    View view = view_at(instance);
    Face face = face_at(uint(face_beside.x));
    ivec2 count = ivec2(face.count_u, face.count_v);
    vec2 beside = beside_edge(ends, t);
    Patch patch_;
    vec2 uv;
    ivec2 place = seed_place(face, int(face_beside.y), beside, patch_, uv);
    Sample s;
    vec2 fold;
    point = e;
    if (!find_fold(face, place.y * count.x + place.x, view, uv, centre, s, fold)) return 0.0;
    point = EdgePoint(s.q.xy / s.q.w, seen_from_eye(s.q), vec2(FOLD_SHEET_PX, e.slack.y));
    vec2 run = ends.zw - ends.xy;
    bool is_in_face = dot(fold - beside, face_beside.z * vec2(-run.y, run.x)) > 0.0;
    // and ends where the edge does
    float ahead = dot(fold - ends.xy, run) / dot(run, run) * (1.0 - 2.0 * SEED_END) + SEED_END;
    is_in_face = is_in_face && abs(ahead - 0.5) <= 0.5 + SEED_ROUNDED;
    bool is_close = distance(point.pixel, e.pixel) <= SEED_REACH_PX;
    if (!is_in_face || !is_close) return 0.0;
    // other trims may end the face before the fold; closer to the edge they are not exact enough to tell
    float way = length(point.place - e.place) * frame.focal / (frame.perspective != 0u ? point.place.z : 1.0);
    vec2 before = mix(fold, beside, BEFORE_FOLD);
    if (way > TRIMS_TELL_PX && !is_left(uint(face_beside.x), face, instance, before)) return 0.0;
    return line_coverage(length(s.miss), push.half_px.x);
}

// A point of the edge.
void test(Chord c, EdgePiece piece, View view, vec2 from, float share, ivec2 at) {
    vec2 along = c.b - c.a;
    float half_px = push.half_px[c.style & EDGE_STYLE];
    float covered = line_coverage(length(from - share * along), half_px);
    uint steps = uint(covered * LINE_STEPS + 0.5);
    uint best = LINE_SEEN | steps << LINE_COVERAGE | chord;
    if (steps == 0u || imageLoad(lines, at).x >= best) return;
    EdgePoint e = point_at(parameter_at(c, share), piece, view);
    bool near = (c.style & EDGE_NEAR) == 0u || is_near_own(e);
    if (!near || !is_seen(e, at) || is_covered(e, at)) {
        bool is_dashed = (c.style & EDGE_TURNS) == 0u;
        steps = is_dashed ? uint(covered * dash(along, centre, half_px) * LINE_STEPS + 0.5) : 0u;
        if (push.hidden == 0u || steps == 0u) return;
        best = steps << LINE_COVERAGE | chord;
    }
    imageAtomicMax(lines, at, best);
}

// The fold beside the edge.
void look(Chord c, PieceInstance piece_instance, EdgePiece piece, float t, EdgePoint e, uvec2 item) {
    int texel = int(piece.first + piece.degree + 1u + SEED_TEXELS * ((item.y >> LINE_SEED) - 1u));
    vec4 beside = texelFetch(edge_points, texel);
    vec4 ends = texelFetch(edge_points, texel + 1);
    uint instance = beside.w > 0.0 ? uint(beside.w) - 1u : piece_instance.placement;
    EdgePoint p;
    uint steps = uint(fold_beside(beside, ends, t, e, instance, p) * LINE_STEPS + 0.5);
    if (steps != 0u) put_found(Found(item.x, item.y, steps, p.pixel, p.place, p.slack.y));
}

void main() {
    uint i = thread_number();
    if (i >= items_of_step()) return;
    if (LINE_STEP == STEP_FOUND) {
        Found f = found_at(i);
        ivec2 at = line_pixel(f.pixel);
        chord = f.what & LINE_CHORD;
        uint best = LINE_SEEN | f.steps << LINE_COVERAGE | LINE_FOLD;
        EdgePoint e = EdgePoint(f.place, f.from_eye, vec2(FOLD_SHEET_PX, f.off));
        if (imageLoad(lines, at).x >= best || !is_seen(e, at) || is_covered(e, at)) return;
        imageAtomicMax(lines, at, best);
        return;
    }
    uvec2 item = item_at(i);
    ivec2 at = line_pixel(item.x);
    centre = vec2(at) + 0.5;
    chord = item.y & LINE_CHORD;
    Chord c = chords[chord];
    vec2 along = c.b - c.a;
    vec2 from = centre - c.a;
    float size = dot(along, along);
    float share = size > 0.0 ? clamp(dot(from, along) / size, 0.0, 1.0) : 0.0;
    PieceInstance piece_instance = piece_instances[c.piece_instance];
    EdgePiece piece = edge_pieces[piece_instance.piece];
    View view = view_at(piece_instance.placement);
    if (LINE_STEP == STEP_TEST) {
        test(c, piece, view, from, share, at);
    } else {
        float t = parameter_at(c, share);
        look(c, piece_instance, piece, t, point_at(t, piece, view), item);
    }
}
