#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `gap_write`: writes the decisions of pass `gap_fill` into the visibility image. It is a pass of its own, because
// `gap_fill` reads what was drawn at a pixel's neighbours. One thread a gap candidate.
#include "scene.glsl"
#include "visible.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"
layout(scalar, binding = 0) uniform Frames { Frame frame; };
layout(binding = 1, rg32ui) writeonly uniform uimage2D visibility;
layout(scalar, binding = 2) readonly buffer GapCandidates { GapCandidate candidates[]; };
layout(scalar, binding = 3) readonly buffer Bands { GapBand band_list; };

void main() {
    uint n = thread_number();
    if (n >= min(band_list.count, frame.gap_candidate_capacity)) return;
    imageStore(visibility, candidate_pixel(candidates[n].pixel), uvec4(candidates[n].word, 0u, 0u));
}
