#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `edge_count`: how many chords each piece of an edge takes in this view. One thread a placed piece. Twin:
// src/twin/edges.rs.
#include "scene.glsl"
#include "view.glsl"
#include "edges.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Views { View views[]; };
layout(scalar, binding = 2) readonly buffer PieceInstances { PieceInstance piece_instances[]; };
layout(scalar, binding = 3) readonly buffer EdgePieces { EdgePiece edge_pieces[]; };
layout(binding = 4) uniform samplerBuffer edge_points;
layout(scalar, binding = 5) writeonly buffer ChordCounts { uint chord_counts[]; };
layout(scalar, binding = 6) buffer CountersBuffer { Counters counters; };
layout(scalar, binding = 7) readonly buffer EdgeLines { EdgeLine edge_lines[]; };

layout(scalar, push_constant) uniform Push {
    uint instance_count;
    float margin_px;
} push;

uint counted = 0u;

void put_chords(uint n, uint chords, float a, float b) { counted += chords; }

#include "edge_divide.glsl"

void main() {
    uint i = thread_number();
    if (i >= push.instance_count) return;
    PieceInstance piece_instance = piece_instances[i];
    EdgePiece piece = edge_pieces[piece_instance.piece];
    View view = views[piece_instance.placement];
    bool is_drawn = (edge_lines[piece.edge].style & EDGE_TURNS) == 0u || is_outline(piece, view);
    if (is_drawn && divide(piece, view)) atomicAdd(counters.clamps, 1u);
    chord_counts[i] = counted;
}
