#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `edge_join`: lines through the places that pass `edge_change` found.
//
//      ●──x──●     four centres, and where what is seen changes on the ways between them: two places, a stretch of a line;
//      │   ╲ │     more, stretches to their mean. A pixel around gets the largest share that one of them covers of it
//      │    ╲x
//      ●─────●
#include "scene.glsl"
#include "view.glsl"
#include "edges.glsl"

layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rg32ui) readonly uniform uimage2D changes;
layout(binding = 2, r32ui) uniform uimage2D lines;

layout(scalar, push_constant) uniform Push { vec3 half_px; } push; // of lines: full, thin, bold

float from_stretch(vec2 p, vec2 a, vec2 b) {
    vec2 along = b - a;
    float size = dot(along, along);
    float share = size > 0.0 ? clamp(dot(p - a, along) / size, 0.0, 1.0) : 0.0;
    return length(p - a - share * along);
}

void main() {
    ivec2 at = ivec2(gl_FragCoord.xy);
    ivec2 last = ivec2(frame.size) - 1;
    uvec2 here = imageLoad(changes, at).xy;
    uint right = at.x < last.x ? imageLoad(changes, at + ivec2(1, 0)).y : 0u;
    uint below = at.y < last.y ? imageLoad(changes, at + ivec2(0, 1)).x : 0u;
    uint words[4] = uint[](here.x, here.y, right, below);
    vec2 places[4];
    float half_px[4];
    uint count = 0u;
    vec2 mean = vec2(0.0);
    float widest = 0.0;
    for (uint k = 0u; k < 4u; ++k) {
        if (words[k] == 0u) continue;
        float share = float(words[k] & ((1u << CHANGE_STYLE) - 1u)) / CHANGE_SHARES;
        bool across = k == 0u || k == 3u;
        vec2 place = vec2(at) + 0.5 + (across ? vec2(share, k == 3u ? 1.0 : 0.0) : vec2(k == 2u ? 1.0 : 0.0, share));
        uint style = words[k] >> CHANGE_STYLE;
        places[count] = place;
        half_px[count] = min(style == LINE_FULL ? push.half_px.x : style == LINE_THIN ? push.half_px.y : push.half_px.z, MOST_HALF_PX);
        widest = max(widest, half_px[count]);
        mean += place;
        ++count;
    }
    if (count == 0u) return;
    mean /= float(count);
    int reach = int(ceil(widest + 0.5));
    ivec2 low = max(at - reach, ivec2(0));
    ivec2 high = min(at + 1 + reach, last);
    for (int y = low.y; y <= high.y; ++y) {
        for (int x = low.x; x <= high.x; ++x) {
            float covered = 0.0;
            for (uint k = 0u; k < count; ++k) {
                float away = from_stretch(vec2(x, y) + 0.5, places[k], mean);
                covered = max(covered, line_coverage(away, half_px[k]));
            }
            uint steps = uint(covered * LINE_STEPS + 0.5);
            if (steps > 0u) imageAtomicMax(lines, ivec2(x, y), LINE_SEEN | steps << LINE_COVERAGE | LINE_SOLID);
        }
    }
}
