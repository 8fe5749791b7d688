// The placed parts in sight, and the lists of those whose patches a frame looks at. A part of many patches is several
// of them: groups of its faces. Structs: src/abi/parts.rs; twin: src/twin/parts.rs.
//
//   hidden before   hidden now     LIST_FIRST is made before this frame's test, from the last result. The other two are
//        no            no   first  made after it.
//        no           yes   first
//       yes            no          appearing         all: whatever is in one of the other two
//       yes           yes          not listed
#ifndef PARTS_GLSL
#define PARTS_GLSL

// A placed part in sight, or a group of its faces.
struct PartInSight {
    uint group; // its number among the groups of all placed parts
    uint first_patch_instance;
    uint patch_instances; // their number, above 0
    float depth;          // reversed depth that nothing drawn of it exceeds; 1 if it is never hidden
    uint low;             // first pixel of a rectangle with all that is drawn of it: column | row << 16
    uint high;            // its last pixel
};

const uint LIST_FIRST = 0u;     // parts that were not hidden
const uint LIST_APPEARING = 1u; // parts that were hidden and are no longer
const uint LIST_ALL = 2u;       // both, and nothing else

// Push constants.
struct PartList {
    uint parts; // number of parts in sight
    uint list;  // LIST_*
};

// The dispatches over the patch instances of listed parts.
struct ListDispatches {
    uvec3 threads; // workgroups of passes with a thread for each
    uvec3 blocks;  // workgroups of prefix sums with an element of each list for each, and one more
    uint scanned;  // the number of these elements
};

#endif
