// A face that may belong at a gap candidate, as its own surface and trims have it there. Twin: src/twin/gap_decide.rs.
// Needs gap_radius.glsl and the frame's constants.
#ifndef GAP_CANDIDATE_GLSL
#define GAP_CANDIDATE_GLSL

#include "on_pixel.glsl"

// What a face is at the pixel's centre.
const uint ABSENT = 0u;
const uint NEAR = 1u;    // a border or silhouette of it is within the gap radius
const uint PRESENT = 2u; // its surface passes the centre, inside its trims; of the pixel's own face: and the whole gap radius

// Where it was seen.
const uint FROM_BESIDE = 0u; // by the next pixel
const uint FROM_BEYOND = 1u; // beyond other gap candidates
const uint FROM_FOLD = 2u;   // it is the pixel's own face, across a silhouette

struct Candidate {
    uint kind;
    uint from;
    uint face;   // of the scene, + 1; 0 where it is no patch
    bool inside; // its trims, at the centre
    bool away;   // looks away from the viewer
    float depth;
    float miss;  // from the centre to the nearest point of its surface, pixels
    vec2 slope;  // of its depth, a pixel
    uvec2 word;  // for the visibility buffer
};

Candidate no_candidate() {
    return Candidate(ABSENT, FROM_BESIDE, 0u, false, false, 3.0e38, 3.0e38, vec2(0.0), uvec2(0u));
}

// How much its depth changes within the gap radius.
float lean(Candidate c) { return GAP_SLACK * frame.gap_radius_px * length(c.slope); }

// In all of the gap radius: surfaces that meet within it are not.
bool wholly_before(Candidate a, Candidate b) { return a.depth + lean(a) + lean(b) < b.depth; }

#endif
