#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `line_list`: a rectangle around each chord, half a pixel wider than its line and the folds beside it. One
// instance a chord.
#include "scene.glsl"
#include "edges.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) readonly buffer Chords { Chord chords[]; };

layout(scalar, push_constant) uniform Push {
    vec3 half_px; // of lines: full, thin, bold
    uvec2 capacities;
} push;

layout(location = 0) flat out uint chord;

// A vertex' pixel is rounded: rectangles are wider by this.
const float ROUNDED_PX = 0.0625;

void main() {
    chord = gl_InstanceIndex;
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
