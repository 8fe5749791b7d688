#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `border_find`: the list of pixels beside another face, another thing, or a jump of the depth. One thread a column of
// 16 pixels, whose neighbours' columns it learns from the threads beside it; the first and the last of a workgroup do
// nothing else.
//
//     a b c     another pixel among the eight around; or, of a face that hides itself, a jump of J between two pixels: the
//     d x e     depths of three pixels in a row bend by J, and climb by as much, where those of one surface bend little
//     f g h
#include "scene.glsl"
#include "view.glsl"
#include "words.glsl"
#include "visible.glsl"
#include "shade.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
#include "grid.glsl"
#include "border_pixel.glsl"
layout(binding = 1) uniform usamplerBuffer items; // a word a placed patch
layout(binding = 2, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 3, rgba32f) readonly uniform image2D resolved; // linear colour, depth; UNSEEN where nothing is
layout(scalar, binding = 4) writeonly buffer List { BorderPixel list[]; };
layout(scalar, binding = 5) buffer Dispatch { uvec3 dispatch; uint count; }; // of the next step; zero before

const uint GROUP = 64u; // threads of a workgroup of the next step
const int LANES = 64;
const int ROWS = 16;
const uint OTHER = 0xffffffffu; // a mesh or solid, whichever

shared uint keys[(ROWS + 2) * LANES];
shared float depths[(ROWS + 2) * LANES];

// Placed face + 1, OTHER, or 0 where nothing is seen.
uint key_at(ivec2 at, float depth) {
    uint word = imageLoad(visibility, at).x;
    if (sees_nothing(word) || sees_other(word)) return depth < UNSEEN ? OTHER : 0u;
    // what the host drew hides it
    if (frame.background.a < 0.0 && depth >= UNSEEN) return 0u;
    return word_at(items, seen_item(word)) + 1u;
}

void main() {
    int lane = int(gl_LocalInvocationID.x);
    ivec2 first = ivec2(int(gl_WorkGroupID.x) * (LANES - 2) + lane - 1, int(gl_WorkGroupID.y) * ROWS - 1);
    ivec2 last = ivec2(frame.size) - 1;
    for (int row = 0; row < ROWS + 2; ++row) {
        ivec2 at = clamp(first + ivec2(0, row), ivec2(0), last); // beside the picture as at its border
        float depth = imageLoad(resolved, at).a;
        keys[row * LANES + lane] = key_at(at, depth);
        depths[row * LANES + lane] = depth;
    }
    barrier();
    if (lane == 0 || lane == LANES - 1 || first.x > last.x) return;
    const int ways[4] = int[](1, LANES - 1, LANES, LANES + 1);
    uint listed = 0u;
    for (int row = 1; row <= ROWS; ++row) {
        int middle = row * LANES + lane;
        uint key = keys[middle];
        float here = depths[middle];
        bool alone = true;
        bool jump = false;
        for (int k = 0; k < 4; ++k) {
            int before = middle - ways[k];
            int behind = middle + ways[k];
            alone = alone && keys[before] == key && keys[behind] == key;
            jump = jump || jumps(depths[before] - here, depths[behind] - here, here);
        }
        bool patch_ = key != 0u && key != OTHER;
        if (first.y + row <= last.y && (!alone || patch_ && jump)) listed |= 1u << row;
    }
    for (; listed != 0u; listed &= listed - 1u) {
        ivec2 at = first + ivec2(0, findLSB(listed));
        uint n = atomicAdd(count, 1u);
        list[n].pixel = uint(at.x) | uint(at.y) << 16;
        uvec3 grid = grid_of(n / GROUP + 1u);
        for (uint axis = 0u; axis < 3u; ++axis) atomicMax(dispatch[axis], grid[axis]);
    }
}
