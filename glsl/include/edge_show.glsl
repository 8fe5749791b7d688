// Pass `edge_show`: each pixel's line over its colour, and its edge's number. Where the target holds the colours of
// `resolved` over the scene's background, the entry point defines SHOWS_RESOLVED: it is written without blending.
#ifndef EDGE_SHOW_GLSL
#define EDGE_SHOW_GLSL

#include "scene.glsl"
#include "view.glsl"
#include "edges.glsl"
#include "shade.glsl"
#include "visible.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, r32ui) readonly uniform uimage2D lines;
layout(scalar, binding = 2) readonly buffer Chords { Chord chords[]; };
layout(scalar, binding = 3) readonly buffer PieceInstances { PieceInstance piece_instances[]; };
layout(scalar, binding = 4) readonly buffer EdgePieces { EdgePiece edge_pieces[]; };
layout(scalar, binding = 5) readonly buffer EdgeLines { EdgeLine edge_lines[]; };
#ifdef SHOWS_RESOLVED
layout(binding = 6, rgba32f) readonly uniform image2D resolved;
#include "unmixed.glsl"
#else
layout(binding = 6, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 7, rg32ui) readonly uniform uimage2D meshes_and_solids;
#endif

layout(scalar, push_constant) uniform Push {
    vec4 colour; // linear, and opacity
    vec4 hidden; // of hidden lines
} push;

layout(constant_id = 28) const bool HAS_EDGE_IMAGE = false;

layout(location = 0) out vec4 out_colour; // multiplied by its opacity where it is blended
layout(location = 1) out uint out_edge;

// Lines that cover less of a pixel do not count as what covers it: as much as a line may be off, pixels.
const float EDGE_COVERS = 0.1;

// A colour of this opacity over another, neither multiplied by its opacity.
vec4 over(vec3 colour, float opacity, vec4 behind) {
    float rest = behind.a * (1.0 - opacity);
    return vec4((colour * opacity + behind.rgb * rest) / max(opacity + rest, 1e-6), opacity + rest);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    uint line = imageLoad(lines, at).x;
    if (line == 0u) discard;
    float covered = float((line & ~LINE_SEEN) >> LINE_COVERAGE) / LINE_STEPS;
    vec4 colour = (line & LINE_SEEN) != 0u ? push.colour : push.hidden;
    float opacity = colour.a * covered;
    vec3 encoded = encode(colour, frame.encode_srgb).rgb;
#ifdef SHOWS_RESOLVED
    vec4 behind = shown(imageLoad(resolved, at));
    behind = encode(vec4(behind.rgb / max(behind.a, 1e-6), behind.a), frame.encode_srgb);
    out_colour = over(encoded, opacity, behind);
#else
    out_colour = vec4(encoded * opacity, opacity);
    bool empty = sees_nothing(imageLoad(visibility, at).x) && sees_nothing(imageLoad(meshes_and_solids, at).x);
    if (empty && frame.background.a >= 0.0) {
        // the blending adds what is behind, multiplied by 1 - opacity alone
        vec4 behind = encode(frame.background, frame.encode_srgb);
        out_colour.rgb = max(over(encoded, opacity, behind).rgb - behind.rgb * (1.0 - opacity), 0.0);
    }
#endif
    if (!HAS_EDGE_IMAGE) return;
    uint number = (line & LINE_CHORD) == LINE_SOLID ? SOLID_NUMBER : FOLD_NUMBER;
    if ((line & LINE_CHORD) < LINE_SOLID) {
        number = edge_lines[edge_pieces[piece_instances[chords[line & LINE_CHORD].piece_instance].piece].edge].number;
    }
    out_edge = covered >= EDGE_COVERS ? number : 0u;
}

#endif
