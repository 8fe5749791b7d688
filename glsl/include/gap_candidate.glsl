// A face that may be visible at a gap candidate, evaluated by its own surface and trims. Twin: src/twin/gap_decide.rs.
// Needs gap_radius.glsl and the frame's constants.
#ifndef GAP_CANDIDATE_GLSL
#define GAP_CANDIDATE_GLSL

#include "on_pixel.glsl"

// The face at the pixel's centre.
const uint ABSENT = 0u;
const uint NEAR = 1u;    // a border or silhouette of it is within the gap radius
const uint PRESENT = 2u; // its surface passes the centre, inside its trims; own face: the whole gap radius is inside

// The pixel that showed it.
const uint FROM_BESIDE = 0u; // the next pixel
const uint FROM_BEYOND = 1u; // a pixel beyond other gap candidates
const uint FROM_FOLD = 2u;   // the pixel's own face, across a silhouette

struct Candidate {
    uint kind;
    uint from;
    uint face;     // of the scene, + 1; 0 for meshes and solids
    uint instance; // of its part
    bool inside;   // its trims contain the centre
    bool away;     // looks away from the viewer
    float depth;
    float miss;    // from the centre to the nearest point of its surface, pixels
    vec2 slope;    // of its depth, a pixel
    uvec2 word;    // for the visibility buffer
};

Candidate no_candidate() {
    return Candidate(ABSENT, FROM_BESIDE, 0u, 0u, false, false, 3.0e38, 3.0e38, vec2(0.0), uvec2(0u));
}

// Change of its depth within the gap radius.
float lean(Candidate c) { return GAP_SLACK * frame.gap_radius_px * length(c.slope); }

// Whether a is before b in all of the gap radius; surfaces that meet within it are not.
bool wholly_before(Candidate a, Candidate b) { return a.depth + lean(a) + lean(b) < b.depth; }

#endif
