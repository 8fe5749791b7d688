#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `border_find`: the list of pixels beside another face, another thing, or a jump of the depth, in some rows of
// the picture. One thread a column of 16 pixels; the nine pixels around go with it down the column.
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
const int ROWS = 16;
const uint OTHER = 0xffffffffu; // a mesh or solid, whichever
const uint FACET = 0xfffffffeu; // a triangle of an operand, whichever
// Of roots of linear light: steps of less leave no stair that is seen.
const float TINT_STEP = 1.0 / 24.0;

ivec2 inside(ivec2 at) { return clamp(at, ivec2(0), ivec2(frame.size) - 1); } // beside the picture as at its border

// What is seen as one: a placed face, a placed mesh, a side of a solid, OTHER where it is not sampled; 0 where nothing
// is.
uint key_at(ivec2 at, float depth) {
    uint word = imageLoad(visibility, at).x;
    if (sees_nothing(word) || sees_other(word)) {
        if (depth >= UNSEEN) return 0u;
        if (!SCENE_HAS_MESHES_OR_SOLIDS) return OTHER;
        if (sees_nothing(word)) word = imageLoad(meshes_and_solids, at).x;
        if (!is_sampled(word)) return OTHER;
        return sees_solid(word) && seen_side(word) >= frame.side_count ? FACET : word;
    }
    // what the host drew hides it
    if (frame.background.a < 0.0 && depth >= UNSEEN) return 0u;
    return word_at(patch_instances, seen_patch_instance(word)) + 1u;
}

vec3 tint_at(ivec2 at) { return sqrt(max(imageLoad(resolved, inside(at)).rgb, 0.0)); }

// Whether the tint changes to a pixel to the sides, or above or below.
bool is_crease(ivec2 at) {
    const ivec2 ways[4] = ivec2[](ivec2(-1, 0), ivec2(1, 0), ivec2(0, -1), ivec2(0, 1));
    vec3 own = tint_at(at);
    bool is = false;
    for (int k = 0; k < 4; ++k) is = is || any(greaterThan(abs(tint_at(at + ways[k]) - own), vec3(TINT_STEP)));
    return is;
}

// Three pixels beside each other.
struct Three {
    uvec3 keys;
    vec3 depths;
};

Three three_around(ivec2 middle) {
    Three three;
    for (int k = 0; k < 3; ++k) {
        ivec2 at = inside(middle + ivec2(k - 1, 0));
        three.depths[k] = imageLoad(resolved, at).a;
        three.keys[k] = key_at(at, three.depths[k]);
    }
    return three;
}

void main() {
    ivec2 first = ivec2(gl_GlobalInvocationID.x, int(top) + int(gl_WorkGroupID.y) * ROWS);
    if (first.x >= int(frame.size.x)) return;
    Three above;
    Three here = three_around(first - ivec2(0, 1));
    Three below = three_around(first);
    uint listed = 0u;
    for (int row = 0; row < ROWS; ++row) {
        ivec2 at = first + ivec2(0, row);
        above = here;
        here = below;
        below = three_around(at + ivec2(0, 1));
        uint key = here.keys.y;
        float depth = here.depths.y;
        bool alone = here.keys == uvec3(key) && above.keys.y == key && below.keys.y == key;
        vec4 before = vec4(here.depths.x, above.depths.yzx);
        vec4 behind = vec4(here.depths.z, below.depths.yxz);
        bvec4 jump = jumps(before - depth, behind - depth, depth);
        bool crease = false;
        if (SCENE_HAS_MESHES_OR_SOLIDS) {
            // a straight border within a pixel is also between its centre and one to the sides, or above or below
            jump.zw = bvec2(false);
            crease = (sees_mesh(key) || key == FACET) && is_crease(at);
        } else {
            alone = alone && above.keys == uvec3(key) && below.keys == uvec3(key);
        }
        bool sampled = key != 0u && key != OTHER;
        if (at.y < int(end) && (!alone || sampled && any(jump) || crease)) listed |= 1u << row;
    }
    if (listed == 0u) return;
    uint count = uint(bitCount(listed));
    uint n = atomicAdd(grids.count, count);
    uint last = n + count - 1u;
    for (; listed != 0u; listed &= listed - 1u) {
        ivec2 at = first + ivec2(0, findLSB(listed));
        list[n].pixel = uint(at.x) | uint(at.y) << 16;
        list[n].sliver = NO_SLIVER;
        ++n;
    }
    uvec3 pixels = grid_of(last / GROUP + 1u);
    uvec3 points = grid_of(last / (GROUP / POINTS) + 1u);
    for (uint axis = 0u; axis < 3u; ++axis) {
        atomicMax(grids.pixels[axis], pixels[axis]);
        if (SCENE_HAS_MESHES_OR_SOLIDS) atomicMax(grids.points[axis], points[axis]);
    }
}
