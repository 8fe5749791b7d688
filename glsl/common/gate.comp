#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `gate`: if a list of this frame overflowed, no patch is drawn. The host then enlarges the list and records the
// frame again. One thread. Twin: src/twin/gate.rs.
#include "scene.glsl"

layout(local_size_x = 1) in;
layout(scalar, binding = 0) buffer CountersBuffer { Counters counters; };

void main() {
    if (counters.failed == 0u) return;
    counters.plain_draws = 0u;
    counters.trimmed_draws = 0u;
    counters.corner_draws = 0u;
    counters.trimmed_corner_draws = 0u;
}
