// Points of pixels at borders for which the exact surface is followed, from pass `border_mix` to passes `border_follow`
// and `border_followed`.
//
//     border_mix ──▶ points │ a a a b b c c c c … │     the points of a pixel lie one behind the other
//                    pixels │ a b c … │                 in scenes without meshes and Boolean solids: whose mean waits
//
//     list.mean of such a pixel, until its mean is there     what its points show, four bits each
#ifndef BORDER_FOLLOWED_GLSL
#define BORDER_FOLLOWED_GLSL

// sheets: a sheet to follow has four bits, 1 + the pixel around from which it is followed, in the order in which sheets
// were found. From bit FOLLOWED_SHOWN on, what the point shows so far.
struct FollowedPoint {
    uint point; // BORDER_POINTS times the pixel's place in the list, and which of its points
    uint sheets;
    float depth; // of what it shows so far; UNSEEN of nothing
};

struct FollowedPixel {
    uint place; // in the list of pixels
    uint first; // of its points
    uint bits;  // of points to follow; from bit BORDER_POINTS on, of pixels around that see no patch
};

// How many there are, and the grids of a thread for each. All are 0 before pass `border_mix`.
struct FollowedGrids {
    uvec3 points;
    uint point_count;
    uvec3 pixels;
    uint pixel_count;
    uint wanted; // points, with those for which there is no room
};

const uint FOLLOWED_SHOWN = 16u;
const uint FOLLOWED_GROUP = 64u; // threads of a workgroup of passes over these lists

#endif
