#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `border_find`: the list of pixels beside another face, another thing, or a jump of the depth, in some rows of
// the picture. One thread a column of 16 pixels, whose neighbours' columns it learns from the threads beside it; the
// first and the last of a workgroup do nothing else.
//
//     a b c     another pixel among the eight around, in scenes with meshes or solids among b, d, e and g; or, of a surface
//     d x e     that hides itself, a jump of J between two pixels: the depths of three pixels in a row bend by J, and climb
//     f g h     by as much, where those of one surface bend little; or, of a mesh, another tint: a crease
#include "scene.glsl"
#include "view.glsl"
#include "words.glsl"
#include "visible.glsl"
#include "shade.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
#include "grid.glsl"
#include "border_pixel.glsl"
#include "border_kinds.glsl"
layout(binding = 1) uniform usamplerBuffer patch_instances; // a word a placed patch
layout(binding = 2, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 3, rg32ui) readonly uniform uimage2D meshes_and_solids; // in scenes without trims the same
layout(binding = 4, rgba32f) readonly uniform image2D resolved; // linear colour, depth; UNSEEN where nothing is
layout(scalar, binding = 5) writeonly buffer List { BorderPixel list[]; };
layout(scalar, binding = 6) buffer Grids { BorderGrids grids; }; // zero before
layout(scalar, push_constant) uniform Rows {
    uint top;
    uint end;
};

const uint GROUP = 64u; // threads of a workgroup of the next steps
const uint POINTS = 16u; // of a pixel
const int LANES = 64;
const int ROWS = 16;
const uint OTHER = 0xffffffffu; // a mesh or solid, whichever
const uint FACET = 0xfffffffeu; // a triangle of an operand, whichever
// Of roots of linear light: steps of less leave no stair that is seen.
const float TINT_STEP = 1.0 / 24.0;

shared uint keys[(ROWS + 2) * LANES];
shared float depths[(ROWS + 2) * LANES];
shared uint tints[(ROWS + 2) * LANES]; // colours of meshes: roots of linear light, as bytes

// What is seen as one: a placed face, a placed mesh, a side of a solid, OTHER where it is not sampled; 0 where nothing
// is.
uint key_at(ivec2 at, float depth) {
    uint word = imageLoad(visibility, at).x;
    if (sees_nothing(word) || sees_other(word)) {
        if (depth >= UNSEEN) return 0u;
        if (sees_nothing(word)) word = imageLoad(meshes_and_solids, at).x;
        if (!is_sampled(word)) return OTHER;
        return sees_solid(word) && seen_side(word) >= frame.side_count ? FACET : word;
    }
    // what the host drew hides it
    if (frame.background.a < 0.0 && depth >= UNSEEN) return 0u;
    return word_at(patch_instances, seen_patch_instance(word)) + 1u;
}

bool tints_differ(uint a, uint b) {
    vec4 step_ = abs(unpackUnorm4x8(a) - unpackUnorm4x8(b));
    return max(step_.x, max(step_.y, step_.z)) > TINT_STEP;
}

void main() {
    int lane = int(gl_LocalInvocationID.x);
    ivec2 first = ivec2(int(gl_WorkGroupID.x) * (LANES - 2) + lane - 1, int(top) + int(gl_WorkGroupID.y) * ROWS - 1);
    ivec2 last = ivec2(frame.size) - 1;
    for (int row = 0; row < ROWS + 2; ++row) {
        ivec2 at = clamp(first + ivec2(0, row), ivec2(0), last); // beside the picture as at its border
        vec4 seen = imageLoad(resolved, at);
        keys[row * LANES + lane] = key_at(at, seen.a);
        depths[row * LANES + lane] = seen.a;
        if (SCENE_HAS_MESHES_OR_SOLIDS) tints[row * LANES + lane] = packUnorm4x8(vec4(sqrt(max(seen.rgb, 0.0)), 0.0));
    }
    barrier();
    if (lane == 0 || lane == LANES - 1 || first.x > last.x) return;
    const int ways[4] = int[](1, LANES, LANES - 1, LANES + 1);
    uint listed = 0u;
    for (int row = 1; row <= ROWS; ++row) {
        int middle = row * LANES + lane;
        uint key = keys[middle];
        float here = depths[middle];
        bool alone = true;
        bool jump = false;
        bool step_ = false;
        // a straight border within a pixel is also between its centre and one to the sides, or above or below
        int way_count = SCENE_HAS_MESHES_OR_SOLIDS ? 2 : 4;
        for (int k = 0; k < way_count; ++k) {
            int before = middle - ways[k];
            int behind = middle + ways[k];
            alone = alone && keys[before] == key && keys[behind] == key;
            jump = jump || jumps(depths[before] - here, depths[behind] - here, here);
            if (SCENE_HAS_MESHES_OR_SOLIDS) {
                step_ = step_ || tints_differ(tints[before], tints[middle]) || tints_differ(tints[behind], tints[middle]);
            }
        }
        bool sampled = key != 0u && key != OTHER;
        bool crease = SCENE_HAS_MESHES_OR_SOLIDS && (sees_mesh(key) || key == FACET) && step_;
        if (first.y + row < int(end) && (!alone || sampled && jump || crease)) listed |= 1u << row;
    }
    for (; listed != 0u; listed &= listed - 1u) {
        ivec2 at = first + ivec2(0, findLSB(listed));
        uint n = atomicAdd(grids.count, 1u);
        list[n].pixel = uint(at.x) | uint(at.y) << 16;
        uvec3 pixels = grid_of(n / GROUP + 1u);
        uvec3 points = grid_of(n / (GROUP / POINTS) + 1u);
        for (uint axis = 0u; axis < 3u; ++axis) {
            atomicMax(grids.pixels[axis], pixels[axis]);
            if (SCENE_HAS_MESHES_OR_SOLIDS) atomicMax(grids.points[axis], points[axis]);
        }
    }
}
