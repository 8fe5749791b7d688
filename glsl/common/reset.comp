#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `reset`: empty draws and zero counters. One thread a draw. Before patches are drawn a second time (DRAWS_ONLY)
// the other counters stay.
#include "scene.glsl"

layout(constant_id = 25) const bool DRAWS_ONLY = false;

layout(local_size_x = 64) in;
#include "thread.glsl"
struct Draw {
    uint vertex_count;
    uint instance_count;
    uint first_vertex;
    uint first_instance;
};
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(scalar, binding = 1) writeonly buffer Draws { Draw draws[]; };
layout(scalar, binding = 2) buffer CountersBuffer { Counters counters; };

void main() {
    uint draw = thread_number();
    if (draw == 0u && DRAWS_ONLY) {
        counters.plain_draws = 0u;
        counters.trimmed_draws = 0u;
        counters.corner_draws = 0u;
        counters.trimmed_corner_draws = 0u;
    }
    if (draw == 0u && !DRAWS_ONLY) {
        counters = Counters(0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u,
                            0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u, 0u);
    }
    if (draw < (2u + frame.corner_lists) * frame.draw_capacity) draws[draw] = Draw(0u, 1u, 0xffffffffu, 0u);
}
