#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `line_list`: a rectangle around each chord, half a pixel wider than its line and the folds beside it; and whether
// the chords before and after it go on along its edge. One instance a chord.
#include "scene.glsl"
#include "edges.glsl"
#include "joints.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Chords { Chord chords[]; };
layout(scalar, binding = 6) readonly buffer PieceInstances { PieceInstance piece_instances[]; };
layout(scalar, binding = 7) readonly buffer EdgePieces { EdgePiece edge_pieces[]; };
layout(scalar, binding = 8) readonly buffer EdgeDraw { uint edge_draw[5]; };

layout(scalar, push_constant) uniform Push {
    vec3 half_px; // of lines: full, thin, bold
    uvec2 capacities;
} push;

layout(location = 0) flat out uint chord;
layout(location = 1) flat out uint joins; // JOINS_*

// A vertex' pixel is rounded: rectangles are wider by this.
const float ROUNDED_PX = 0.0625;

// Ends of chords that belong to one point of an edge: of two pieces they are rounded apart.
const float JOINT_PX = 1.0 / 64.0;

// Whether a chord goes on along the edge where the chord listed before it ends.
bool goes_on(Chord before, Chord after) {
    if (distance(before.b, after.a) > JOINT_PX) return false;
    if (before.piece_instance == after.piece_instance) return true;
    PieceInstance a = piece_instances[before.piece_instance];
    PieceInstance b = piece_instances[after.piece_instance];
    return a.instance == b.instance && edge_pieces[a.piece].edge == edge_pieces[b.piece].edge;
}

void main() {
    chord = gl_InstanceIndex;
    joins = 0u;
    if (chord > 0u && goes_on(chords[chord - 1u], chords[chord])) joins |= JOINS_BEFORE;
    if (chord + 1u < edge_draw[1] && goes_on(chords[chord], chords[chord + 1u])) joins |= JOINS_AFTER;
    Chord c = chords[chord];
    vec2 along = c.b - c.a;
    float size = length(along);
    along = size > 0.0 ? along / size : vec2(1.0, 0.0);
    vec2 across = vec2(-along.y, along.x);
    float reach = push.half_px[c.style & EDGE_STYLE] + 0.5 + ROUNDED_PX;
    if (c.style >> EDGE_SEEDS != 0u) reach = max(reach, push.half_px.x + 0.5 + SEED_REACH_PX);
    // two triangles: 0 1 2, 2 1 3
    const uint CORNERS[6] = uint[](0u, 1u, 2u, 2u, 1u, 3u);
    uint corner = CORNERS[gl_VertexIndex];
    vec2 end = (corner & 1u) == 0u ? c.a - reach * along : c.b + reach * along;
    vec2 place = end + ((corner & 2u) == 0u ? -reach : reach) * across;
    gl_Position = vec4(place * 2.0 / frame.size - 1.0, 0.5, 1.0);
}
