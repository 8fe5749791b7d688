// Operands of Boolean solids without equations, *boundary operands*: crossings of the pixel's ray with their surfaces.
// Twin of src/abi/solids.rs.
//
//   pixel ──fragment_starts──▶ Fragment[fragment_counts]   by operand, then by depth
//
//   before pass `operand_sort`: as rasterised    after it: entries and exits of each operand alternate
#ifndef BOUNDARY_OPERANDS_GLSL
#define BOUNDARY_OPERANDS_GLSL

// Fragment.operand: the operand's number and four bits.
const uint FRAGMENT_LEAVES = 0x80000000u; // the ray leaves the operand here
const uint FRAGMENT_SKIRT = 0x40000000u;   // of the skirt around a trimmed face: used only in a gap
const uint FRAGMENT_PATCH = 0x20000000u;  // of a spline face, else of a triangle
const uint FRAGMENT_WITHIN = 0x10000000u; // sorted: the near plane is within the operand
const uint FRAGMENT_OPERAND = 0x0fffffffu;

struct Fragment {
    uint operand;
    float depth;
    uint what;   // triangle, from Frame.side_count on; for a spline face patch instance + 1
    uint uv;     // of the patch
};

// The sorted fragments as texels: a driver fetches a texel at once, but may load a struct word by word.
Fragment fragment_at(usamplerBuffer fragments, uint i) {
    uvec4 texel = texelFetch(fragments, int(i));
    return Fragment(texel.x, uintBitsToFloat(texel.y), texel.z, texel.w);
}

// A mesh around a boundary operand, placed.
struct OperandMesh {
    uint operand;
    uint instance;
    uint first_triangle;
    uint first_plane; // in the list of shared planes, one for each triangle; NO_PLANE if no triangle has one
    uint mirrored;
    uint leaf;        // a leaf that shows it
};

// No other face shares the triangle's plane, which its corners give.
const uint NO_PLANE = 0xffffffffu;

#endif
