// The scene in GPU memory. Twin of src/abi/scene.rs; the build checks every offset.
//
//   Instance ◀── FaceInstance ──▶ Face ──▶ Patch[count_u * count_v] ──▶ points
//                    │              ├────▶ Cell   (a patch within one v-strip: its box and speed)
//                    │              └────▶ Curve  (rational Bézier in (u, v)) ──▶ curve_points
//                    ├── first_patch_instance + local patch = patch instance (one patch of one placed face)
//                    ├── first_cell           + local cell  = cell instance
//                    ├── first_curve          + local curve = curve instance
//                    └── first_bin            + strip * bins + bin = bin instance (a strip's is that of its first bin)
//
//   Patch, side ──▶ Link ──▶ the next side on the same curve: patches of one part, whose instances have the same distance
//
//   Instance ◀── MeshInstance ──▶ Mesh ──▶ triangles (three indices each) ──▶ positions
//                                   └────▶ normals, one a corner of its triangles, or none
//
// (u, v) of a face is normalised: its whole surface covers [0, 1] x [0, 1].
#ifndef SCENE_GLSL
#define SCENE_GLSL

// Patch.shape: degree_u | degree_v << 4 | rational << 8 | side << 9 | borders << 11 | fine net << 15 | pieces of its
// size in the patch before the split, along u << 16, along v << 22
const uint SIDE_OUTSIDE = 0u;  // wholly trimmed away: never drawn
const uint SIDE_INSIDE = 1u;   // no trim curve meets it: drawn without a test
const uint SIDE_BOUNDARY = 2u; // the trim test decides per pixel
const uint BORDER_U0 = 1u;     // the side u = 0 of the patch is a border of the face's surface
const uint BORDER_U1 = 2u;
const uint BORDER_V0 = 4u;
const uint BORDER_V1 = 8u;

struct Patch {
    vec3 box_min;    // part coordinates, relative to the part's origin
    uint first;      // index of the first control point in points
    vec3 box_max;
    uint shape;
    vec4 domain;     // u0, v0, u1 - u0, v1 - v0 within the face
    vec3 bend;       // |S_uu x x + 2 S_uv x y + S_vv y y| <= bend.x x x + 2 bend.y |x y| + bend.z y y, part units
    uint face;
};

// A side of a patch that other faces share: one of a ring of sides. `place` is 0 if the side is not shared. place:
// start | halvings << 13 | reversed << 17 | owner << 18 | shared << 19 The ring's sides lie on one curve; this one
// begins at start / 2^halvings and is 1 / 2^halvings long. The control points of each piece of the curve are those of
// its owner.
struct Link {
    uint next; // 4 * patch + side, of u = 0, v = 0, u = 1, v = 1
    uint place;
};

const uint LINK_MOST_SIDES = 32u;

uint link_start(Link link) { return link.place & 0x1fffu; }
uint link_halvings(Link link) { return (link.place >> 13) & 15u; }
bool link_reversed(Link link) { return ((link.place >> 17) & 1u) != 0u; }
bool link_owner(Link link) { return ((link.place >> 18) & 1u) != 0u; }
bool link_shared(Link link) { return ((link.place >> 19) & 1u) != 0u; }

const uint FACE_CLOSED_U = 1u;   // the sides u = 0 and u = 1 coincide
const uint FACE_CLOSED_V = 2u;
const uint FACE_SAME_SENSE = 4u; // outward normal is S_u x S_v
const uint FACE_SOLID = 8u;      // the part is closed: back faces are never seen
const uint FACE_TRIMMED = 16u;   // some patch meets a trim curve
const uint FACE_OPERAND = 32u;   // belongs to a Boolean solid: drawn only as its fragments
const uint FACE_MEETS_U = 64u;   // the sides u = 0 and u = 1 of the surface meet, whatever the trims
const uint FACE_MEETS_V = 128u;
const uint FACE_POINTS = 8u;     // from this bit on: BORDER_* of the sides that are points
const uint FACE_GOES_ON = 12u;   // the same of the sides where a window of a deep zoom ends, and not the surface

// Members that every pixel reads are whole texels; members read together are in one.
struct Face {
    vec4 domain;        // u0, v0, u1 - u0, v1 - v0 of the source's own parameters

    uint first_patch;
    uint flags;
    uint strips;        // of the trim table: uniform v-strips, bins of each << 16; 0 without a table (u_bins.glsl)
    uint first_curve;

    uint id;
    uint colour;        // linear light, unorm 8 bits each, red lowest
    uint count_u;
    uint count_v;

    uint first_cell;
    uvec3 unused;
};

struct FaceInstance {
    uint face;
    uint instance;
    uint first_patch_instance;
    uint first_bin;

    uint first_cell;
    uint first_curve;
    uvec2 unused;
};

struct Instance {
    mat3 normal;   // part to model, for normals (columns)
    float scale;   // largest stretch of the transform
    uint colour;   // over its faces' colours, by its opacity
    uint mirrored; // 1 if the transform mirrors

    uint operand;    // of its FACE_OPERAND faces: the operand that they bound
    uvec3 unused;
};

const uint MESH_SOLID = 1u;   // the part is closed
const uint MESH_NORMALS = 2u; // its corners have normals

struct Mesh {
    uint first_triangle;
    uint first_normal; // of the first corner of the first triangle
    uint flags;
    uint id;
    uint colour;       // as Face.colour
};

struct MeshInstance {
    uint mesh;
    uint instance;
};

// The part of a patch that lies in one bin of one v-strip.
struct Cell {
    vec3 box_min;
    float speed_u; // largest |S_u|, |S_v| there, part units per unit of normalised u, v
    vec3 box_max;
    float speed_v; // negative if no loop meets the patch, in editable scenes
    uint bin;       // strip * bins + bin
    uint normal;    // octahedral: the surface lies within low <= normal . p <= high
    float low;
    float high;
};

struct Curve {
    vec2 start;     // end points, shared with the neighbours bit for bit
    vec2 end;
    uint first;     // index of the first float in curve_points, three a control point
    uint degree;
    vec2 bend;      // deviation from n equal chords is at most bend / n^2, in u and in v
    vec2 range_v;   // lowest and highest v of the control polygon
    vec2 range_u;   // lowest u of the curve, and highest of its loop
};

// A patch's segments: tau_u | TAU_HIDDEN | tau_v << 16, or 0 if it is not visible.
const uint TAU_HIDDEN = 0x8000u; // not drawn now: it is hidden, or drawn already

uint tau_along(uint tau, uint axis) { return axis == 0u ? tau & 0x7fffu : tau >> 16; }
bool is_drawn(uint tau) { return tau != 0u && (tau & TAU_HIDDEN) == 0u; }

// One frame's view.
struct Frame {
    vec2 size;          // pixels
    float focal;        // the larger of focal_px
    float slant;        // largest stretch of a pixel towards the picture's corners, >= 1
    float near;
    float far;
    uint perspective;
    float deviation_px; // budget of the tessellation
    float gap_radius_px;      // distance by which a trimmed face extends beyond its border to close cracks
    float row_px;       // spacing of the trim table's scan lines
    float chord_px;     // budget of a trim curve's linear segments
    float table_density; // pixels a model unit of the trim table, for every view; 0: those of this view
    uint fixed_factor;  // of every patch; 0: the factor of pass `bound`
    uint listed_patch_instances; // which passes over patches look at (in_sight.glsl)
    uint run_count;     // runs of consecutive patch instances among them (in_sight.glsl)
    uint cell_count;
    uint bin_count;     // of all strips of all placed faces
    uint curve_count;
    uint draw_vertices; // most tessellated vertices in one draw
    uint encode_srgb;   // 1: the shader encodes sRGB for the colour target; ENCODE_SUMMED
    uint sub_patch_capacity;
    uint draw_capacity; // of each list of draws
    uint corner_lists;  // of patches of one segment a side: 0, 1: of plain ones, 2: of trimmed ones, too
    uint row_capacity;
    uint intercept_capacity;
    uint gap_candidate_capacity;
    uint leaf_count;    // of Boolean solids
    uint block_leaf_capacity;
    uint tile_leaf_capacity;
    uint fragment_capacity;
    uint followed_leaf; // from this leaf on, lists of items that rays are followed through; before it, the opaque union
    uint layer_capacity; // of way `blister`
    uint side_count;    // sides of leaves with equations; larger numbers are triangles of operands
    uint band_top;      // rows of pixels of a band of way `events`: the first, a multiple of TILE,
    uint band_height;   // and their number; the picture may end earlier
    vec3 right;         // camera axes in model space
    vec3 up;
    vec3 forward;
    vec4 background;
    vec2 offset;        // of the sample from the pixel's centre, pixels
    float spread_px;    // distance of samples from the centre, along each axis
    uint samples;       // of each pixel's colour
    uint style;         // STYLE_*
    float curvature;    // styles of curvature: one over the largest on the scale, model units
    uint most_groups;   // workgroups in one row of a dispatch
    vec2 focal_px;      // across and down: pixels per unit slope; parallel view: pixels per model unit
    vec2 principal_px;  // pixel of the view axis
};

// Frame.style.
const uint STYLE_SHADED = 0u;
const uint STYLE_CLAY = 1u;
const uint STYLE_NORMALS = 2u;
const uint STYLE_ZEBRA = 3u;
const uint STYLE_ISOPHOTES = 4u;
const uint STYLE_TECHNICAL = 5u;
const uint STYLE_MEAN_CURVATURE = 6u;
const uint STYLE_GAUSSIAN_CURVATURE = 7u;

// A third value of Frame.encode_srgb: linear, clamped to the range of colour targets.
const uint ENCODE_SUMMED = 2u;

// Written by the passes, read back by the host.
struct Counters {
    uint plain;        // sub-patches without and with a trim test
    uint trimmed;
    uint corners;      // of both: drawn by their corners (visibility_corners.vert)
    uint plain_draws;
    uint trimmed_draws;
    uint corner_draws;
    uint trimmed_corner_draws;
    uint rows;
    uint segments;
    uint wanted_rows;  // rows before they were cut to the capacity
    uint intercepts;
    uint gap_candidates;       // pixels for pass gap_fill
    uint band_gap_candidates;  // the most in one band of rows
    uint block_leaves; // leaves of Boolean solids in all blocks of tiles, and in all tiles
    uint tile_leaves;
    uint band_tile_leaves; // the most in one band, or more than can be counted; in one row of tiles
    uint row_tile_leaves;
    uint fragments;    // of operands of Boolean solids; the same of them
    uint band_fragments;
    uint row_fragments;
    uint mended;       // rays through an operand that used a fragment from beside a gap
    uint unpaired;     // rays that enter an operand and never leave it, or leave without entering
    uint contacts;     // pixels whose rays meet coincident faces of two items, and pixels within two items at once
    uint overlaps;
    uint layers;       // peeled by way `blister`
    uint ray_segments;         // of rays through Boolean solids that did not reach their ends
    uint hidden;       // patches of listed parts that are not drawn because they are hidden
    uint hidden_parts; // placed parts in sight that are not listed because they are hidden (parts.glsl)
    uint listed_patches; // patch instances of the listed parts
    uint edge_chords;  // of lines along edges
    uint line_points;  // of lines, of folds beside edges, of folds of faces: to a workgroup (line_list.glsl)
    uint line_seeds;
    uint fold_starts;
    uint followed_points; // of pixels at borders: the most in one list (border_followed.glsl)
    uint clamps;       // factors or densities above their hard limits, loops that a driver ended
    uint failed;       // one bit for each buffer that was too small, and for passes drawn too seldom
};

const uint FAILED_SUB_PATCHES = 1u;
const uint FAILED_DRAWS = 2u;
const uint FAILED_ROWS = 4u;
const uint FAILED_INTERCEPTS = 8u;
const uint FAILED_GAP_CANDIDATES = 16u;
const uint FAILED_BLOCK_LEAVES = 32u;
const uint FAILED_TILE_LEAVES = 64u;
const uint FAILED_FRAGMENTS = 128u;
const uint FAILED_LAYERS = 256u;
const uint FAILED_RAY_SEGMENTS = 512u;
const uint FAILED_EDGE_CHORDS = 1024u;
const uint FAILED_FOLLOWED_POINTS = 2048u;
const uint FAILED_LINES = 4096u;

// Tessellation of one patch instance, decided by the split pass. Totals over the whole patch.
struct Factors {
    uint inner;  // along u | along v << 16
    uint edge_u; // segments of the sides v = 0 | v = 1 << 16
    uint edge_v; // segments of the sides u = 0 | u = 1 << 16
    uint splits; // sub-patches along u | along v << 16; powers of two
};

// A run of consecutive listed patch instances (in_sight.glsl).
struct PatchRun {
    uint place; // of its first one, among all in sight
    uint patch_instance; // its first one
};

struct SubPatch {
    uint patch_instance;
    uint place; // i | j << 8: which of the patch instance's sub-patches
};

// A pixel for pass `gap_fill`.
struct GapCandidate {
    uint pixel;    // column | row << 16 | BORDER_BEFORE | ISOLATED (visible.glsl)
    uvec2 word;  // the visible surface
};

// The list of gap candidates of a band of rows.
struct GapBand {
    uvec3 grid; // of passes with a thread a candidate
    uint count; // all candidates of the band; the list may have room for fewer
};

const uint MAX_FACTOR = 64u;   // the hardware's tessellation factor
const uint MAX_SPLIT = 64u;    // sub-patches along one side
const uint CORNER_VERTICES = 6u; // of a patch that is drawn by its corners: two triangles
// Lists of sub-patches, and of draws. A list of trimmed patches follows that of plain ones: `split` adds 1.
const uint PLAIN_LIST = 0u;
const uint TRIMMED_LIST = 1u;
// as many of these as Frame.corner_lists says: patches of one segment a side
const uint CORNER_LIST = 2u;
const uint TRIMMED_CORNER_LIST = 3u;
const uint MAX_ROWS = 65536u;  // scan lines of one strip

// All faces of an operand determine a ray's way through it, so they do not end at the far plane.
float far_of(Face face, Frame frame) { return (face.flags & FACE_OPERAND) != 0u ? 3.0e38 : frame.far; }

uint degree_u(uint shape) { return shape & 15u; }
uint degree_v(uint shape) { return (shape >> 4) & 15u; }
bool is_rational(uint shape) { return ((shape >> 8) & 1u) != 0u; }
uint side_of(uint shape) { return (shape >> 9) & 3u; }
uint borders_of(uint shape) { return (shape >> 11) & 15u; }
bool has_fine_net(uint shape) { return ((shape >> 15) & 1u) != 0u; }
// Number of pieces of this size in the patch before the split (src/scene/sub_patches.rs), along u and v.
vec2 pieces_of(uint shape) { return vec2(((uvec2(shape) >> uvec2(16u, 22u)) & 63u) + 1u); }

#endif
