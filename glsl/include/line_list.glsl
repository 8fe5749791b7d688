// Lists of what passes `edge_line` and `edge_fold` look at: pixels and what is looked for there. So every thread of them
// has work, where few pixels of the picture have. Twin of src/abi/edges.rs.
//
//   LineList │ pixel what │ pixel what │ …             │ Found │ Found │ …
//            └ items: `capacity` times LINE_ITEM_WORDS  └ folds that a search has found: as many
//
//   pixel: column | row << 16
//   what:  a chord | number of a seed beside it, from 1 on, << LINE_SEED; or the pixel around from which a fold is looked
//          for, 0 to 8
//
// Results are the largest of all, so the order of a list changes nothing.
#ifndef LINE_LIST_GLSL
#define LINE_LIST_GLSL

// How many there are, and the grids of a thread for each; all are 0 before.
struct LineList {
    uvec3 grid;
    uint count; // the list may have room for fewer
    uvec3 found_grid;
    uint found_count;
};

// A fold: where it is, and how much of the pixel its line covers.
struct Found {
    uint pixel;
    uint what;  // of its item; of pass `edge_fold` the patch instance from which it was found
    uint steps; // LINE_COVERAGE
    vec2 place; // in the picture
    vec3 from_eye;
    float off; // EdgePoint.slack, in units of the part
};

const uint LINE_ITEM_WORDS = 2u;
const uint FOUND_WORDS = 9u;
const uint LINE_GROUP = 64u; // threads of a workgroup of passes over the lists
const uint LINE_SEED = 24u;

// Which step of a pass a pipeline is.
layout(constant_id = 47) const uint LINE_STEP = 0u;
const uint STEP_TEST = 0u;  // of items: points of edges
const uint STEP_LOOK = 1u;  // of items: looks for their folds
const uint STEP_FOUND = 2u; // tests the folds that were found

ivec2 line_pixel(uint word) { return ivec2(word & 0xffffu, word >> 16); }
uint line_word(ivec2 at) { return uint(at.x) | uint(at.y) << 16; }

// Whether one of `n` entries from number `at` on is the first of a workgroup: then the grid grows.
bool begins_group(uint at, uint n) { return (at + LINE_GROUP - 1u) / LINE_GROUP * LINE_GROUP < at + n; }

#endif
