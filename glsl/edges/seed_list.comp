#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `seed_list`: beside which chords of smooth edges and seams a fold may be drawn: a bit for each face of the edge.
// One thread a chord.
//
//    ●────○────○────●   places of the chord, SPACING_PX apart: where the surface beside all of them is free of folds up
//                        to SEED_REACH_PX and half the space between places, pixels around need no search
#include "scene.glsl"
#include "view.glsl"
#include "edges.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
#include "placed.glsl"
layout(scalar, binding = 7) readonly buffer Chords { Chord chords[]; };
layout(scalar, binding = 8) readonly buffer PieceInstances { PieceInstance piece_instances[]; };
layout(scalar, binding = 9) readonly buffer EdgePieces { EdgePiece edge_pieces[]; };
layout(binding = 10) uniform samplerBuffer edge_points;
layout(scalar, binding = 11) readonly buffer EdgeDraw { uint edge_draw[5]; };
layout(scalar, binding = 12) writeonly buffer ChordSeeds { uint chord_seeds[]; };

#include "patch.glsl"
#include "patch_place.glsl"
#include "refine.glsl"
#include "fold_near.glsl"

#include "line_seed.glsl"

const float SPACING_PX = 1.0;
const float LEAST_PLACES = 3.0;
const float MOST_PLACES = 32.0;

void main() {
    uint chord = thread_number();
    if (chord >= edge_draw[1]) return;
    Chord c = chords[chord];
    PieceInstance piece_instance = piece_instances[c.piece_instance];
    EdgePiece piece = edge_pieces[piece_instance.piece];
    float size = distance(c.a, c.b);
    uint places = uint(clamp(ceil(size / SPACING_PX), LEAST_PLACES, MOST_PLACES));
    float reach = SEED_REACH_PX + NEAR_OFF_PX + 0.5 * size / float(places - 1u);
    uint seeds = c.style >> EDGE_SEEDS & EDGE_MOST_SEEDS;
    uint bits = 0u;
    for (uint i = 0u; i < seeds * places; ++i) {
        uint k = i / places;
        int texel = int(piece.first + piece.degree + 1u + SEED_TEXELS * k);
        vec4 beside = texelFetch(edge_points, texel);
        vec4 ends = texelFetch(edge_points, texel + 1);
        View view = view_at(beside.w > 0.0 ? uint(beside.w) - 1u : piece_instance.placement);
        Face face = face_at(uint(beside.x));
        Patch patch_;
        vec2 uv;
        float share = float(i % places) / float(places - 1u);
        vec2 at = beside_edge(ends, parameter_at(c, share));
        ivec2 place = seed_place(face, int(beside.y), at, patch_, uv);
        if (!(fold_free(face, place, patch_, view, uv, mix(c.a, c.b, share)) > reach)) bits |= 1u << k;
    }
    chord_seeds[chord] = bits;
}
