#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Decisions about gap candidates, gap_decide.glsl, one thread a pixel, for src/parity/gap_decide.rs.
#include "scene.glsl"
#include "gap_radius.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };

#include "gap_candidate.glsl"
#include "gap_decide.glsl"

const uint MOST_CANDIDATES = 8u;
struct Given {
    uint kind;
    uint from;
    uint face;
    uint instance;
    uint flags; // inside, away, and of its outline: ends
    float depth;
    float miss;
    vec2 slope;
    uvec2 word; // its index among the pixel's, + 1; the own face is the last
    vec2 into;
};
struct Pixel {
    uint flags; // border, isolated, empty, empty_beside, other_beside, other, cut_open, in_solid
    float other_depth;
    uvec2 seen;
    uint count;
    Given given[MOST_CANDIDATES + 1u];
};

layout(scalar, binding = 1) readonly buffer Pixels { Pixel pixels[]; };
layout(scalar, binding = 2) writeonly buffer Answers { uvec2 answers[]; };
layout(push_constant) uniform Push { uint count; };

Candidate candidate(uint k) {
    Given g = pixels[gl_GlobalInvocationID.x].given[k];
    bool inside = (g.flags & 1u) != 0u;
    bool away = (g.flags & 2u) != 0u;
    return Candidate(g.kind, g.from, g.face, g.instance, inside, away, g.depth, g.miss, g.slope, g.word);
}

Outline outline_of(Candidate c, vec2 pixel) {
    Given g = pixels[gl_GlobalInvocationID.x].given[c.word.x - 1u];
    return Outline(g.into, (g.flags & 4u) != 0u);
}

bool flag(uint flags, uint n) { return (flags >> n & 1u) != 0u; }

void main() {
    uint i = gl_GlobalInvocationID.x;
    if (i >= count) return;
    uint flags = pixels[i].flags;
    Situation s = Situation(flag(flags, 0u), flag(flags, 1u), flag(flags, 2u), flag(flags, 3u), flag(flags, 4u),
                            flag(flags, 5u), pixels[i].other_depth, flag(flags, 6u), flag(flags, 7u), pixels[i].seen,
                            candidate(MOST_CANDIDATES));
    Evidence e = no_evidence(s);
    for (uint k = 0u; k < pixels[i].count; ++k) consider(e, s, candidate(k));
    answers[i] = decide(s, e, vec2(0.0));
}
