#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `edge_emit`: the chords of each piece of an edge, in the order of the pieces, and the draw of them all. One
// thread a placed piece. Twin: src/twin/edges.rs.
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
layout(scalar, binding = 5) readonly buffer ChordStarts { uint chord_starts[]; };
layout(scalar, binding = 6) buffer CountersBuffer { Counters counters; };
layout(scalar, binding = 7) readonly buffer EdgeLines { EdgeLine edge_lines[]; };
layout(scalar, binding = 8) writeonly buffer Chords { Chord chords[]; };
layout(scalar, binding = 9) writeonly buffer EdgeDraw { uint edge_draw[5]; }; // the draw, and that there is one

layout(scalar, push_constant) uniform Push {
    uint instance_count;
    float margin_px;
    uint capacity;
} push;

uint next = 0u;
uint own_instance = 0u;
View own_view;
uint own_style = 0u;

void put_chords(uint n, uint count, float a, float b);

#include "edge_divide.glsl"

// The point at a fraction of `net`, as a homogeneous pixel.
vec3 pixel_at(uint n, float t) { return to_pixel(own_view, net_at(n, t)).xyw; }

void put_chords(uint n, uint count, float a, float b) {
    vec3 from = pixel_at(n, 0.0);
    float t0 = a;
    for (uint k = 1u; k <= count; ++k) {
        precise float share = float(k) / float(count);
        precise float t1 = k == count ? b : a + (b - a) * share;
        vec3 to = pixel_at(n, share);
        precise vec2 start = from.xy / from.z;
        precise vec2 end = to.xy / to.z;
        if (next < push.capacity) {
            chords[next] = Chord(start, end, vec2(from.z, to.z), vec2(t0, t1), own_instance, own_style);
        }
        ++next;
        from = to;
        t0 = t1;
    }
}

void main() {
    uint i = thread_number();
    if (i >= push.instance_count) return;
    if (i == 0u) {
        uint total = chord_starts[push.instance_count];
        counters.edge_chords = total;
        if (total > push.capacity) atomicOr(counters.failed, FAILED_EDGE_CHORDS);
        edge_draw[0] = 6u;
        edge_draw[1] = min(total, push.capacity);
        edge_draw[2] = 0u;
        edge_draw[3] = 0u;
        edge_draw[4] = 1u;
    }
    PieceInstance piece_instance = piece_instances[i];
    EdgePiece piece = edge_pieces[piece_instance.piece];
    own_instance = i;
    own_view = views[piece_instance.placement];
    own_style = edge_lines[piece.edge].style;
    next = chord_starts[i];
    if (chord_starts[i + 1u] > next) divide(piece, own_view);
}
