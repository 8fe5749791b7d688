#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `gate`: where something that is drawn from had no room, no patch is drawn: the picture is drawn when there is room.
// One thread. Twin: src/twin/gate.rs.
#include "scene.glsl"

layout(local_size_x = 1) in;
layout(scalar, binding = 0) buffer CountersBuffer { Counters counters; };

void main() {
    if (counters.failed == 0u) return;
    counters.plain_draws = 0u;
    counters.trimmed_draws = 0u;
}
