// Lines along edges. Twin of src/abi/edges.rs; the build checks every offset.
//
//   PieceInstance ──▶ EdgePiece ──▶ degree + 1 control points        a placed rational Bézier piece of an edge
//                    └───────▶ EdgeLine ──▶ own faces            the line along it
//   Chord: from a to b, pixels; of a piece instance                       drawn by a frame
#ifndef EDGES_GLSL
#define EDGES_GLSL

struct EdgePiece {
    uint first; // control point
    uint degree;
    uint edge;
};

struct EdgeLine {
    uint number; // in the image `edge`
    uint style;  // EDGE_*
    uint first_own;
    uint own_count;
    float off; // most distance from its own faces, units of the part
};

struct PieceInstance {
    uint piece;
    uint placement; // number of its view
    uint instance;  // of the model, from 1 on
};

struct Chord {
    vec2 a;
    vec2 b;
    vec2 w; // homogeneous weights of its ends
    vec2 t; // parameters of its ends on the piece
    uint piece_instance;
    uint style;
};

const uint EDGE_FULL = 0u; // the full width of lines
const uint EDGE_THIN = 1u;
const uint EDGE_BOLD = 2u; // outlines of sections
const uint EDGE_STYLE = 3u;
const uint EDGE_NEAR = 4u; // beside it: drawn only where a pixel around sees a face of its own
const uint EDGE_UNDRAWN = 8u; // only folds beside it are drawn
// Sides of triangles, drawn where the mesh turns away at them. Behind the two ends of each: the third corners of both
// triangles.
const uint EDGE_TURNS = 64u;
// From this bit on: how many curved faces a smooth edge has, or sides a seam. Their folds close to the edge are drawn.
const uint EDGE_SEEDS = 4u;
const uint EDGE_MOST_SEEDS = 3u;

// Behind the control points of a piece of such an edge, two texels a face: its number in the scene, a patch of it, 1
// if it lies left of the piece in (u, v) and else -1; (u, v) of the domain beside the piece, SEED_END from its ends: at
// the ends themselves a closed edge is in two places of the face. Last of the first texel: the instance that places the
// face, from 1 on; 0: that of the piece.
const uint SEED_TEXELS = 2u;
const float SEED_END = 0.015625;
// So far from its edge a fold is drawn from there. Farther away a pixel's centre sees the face between them.
const float SEED_REACH_PX = 1.5;

// In the list of own faces: the number of a triangle instead of a face.
const uint OWN_TRIANGLE = 0x80000000u;

// A pixel's line: seen << 31 | coverage << 24 | chord. The best one is the largest.
const uint LINE_SEEN = 0x80000000u;
const uint LINE_COVERAGE = 24u;
const float LINE_STEPS = 127.0;
const uint LINE_CHORD = 0xffffffu;
// In place of a chord: the outline of a curved face, and a line of a Boolean solid. Chords have numbers below these.
const uint LINE_FOLD = LINE_CHORD;
const uint LINE_SOLID = 0xfffffeu;
// Their numbers in the image `edge`.
const uint FOLD_NUMBER = 0xffffffffu;
const uint SOLID_NUMBER = 0xfffffffeu;

// Which lines of Boolean solids are drawn: bits.
const uint LINES_SHARP = 1u;
const uint LINES_SMOOTH = 2u;      // thin, of smooth transitions
const uint LINES_SMOOTH_FULL = 4u; // or as wide as others
const uint LINES_FOLDS = 8u;

// Where what is seen changes between two centres: style << 16 | share of the way.
const uint CHANGE_STYLE = 16u;
const float CHANGE_SHARES = 65535.0;
const uint LINE_NONE = 0u;
const uint LINE_FULL = 1u;
const uint LINE_THIN = 2u;
const uint LINE_BOLD = 3u;
// Half of the widest line of a Boolean solid: drivers end loops over more pixels.
const float MOST_HALF_PX = 100.0;

// The parameter of the edge's piece at a share of the chord.
float parameter_at(Chord c, float share) {
    float from = share * c.w.x;
    return mix(c.t.x, c.t.y, from / (from + (1.0 - share) * c.w.y));
}

// Share of the pixel covered by a line whose middle has this distance from the pixel's centre: exact for lines along
// columns or rows.
float line_coverage(float distance_px, float half_px) {
    return clamp(min(distance_px + 0.5, half_px) - max(distance_px - 0.5, -half_px), 0.0, 1.0);
}

#endif
