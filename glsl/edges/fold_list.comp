#version 460
#extension GL_EXT_scalar_block_layout : require
#extension GL_GOOGLE_include_directive : require
// Pass `fold_list`: where a fold may be beside a pixel: the list of pixels beside which something else is seen, another
// face or another place of the face, each with those around it from which the fold is looked for. Of pixels that see one
// place of a face the first is enough.
//
//    │░│ │ │ … │ │░│   a workgroup: FOLD_COLUMNS columns of FOLD_ROWS pixels, and the pixels around them (░)
//      a thread a column ─▶ a bit a pixel: the face that it sees may fold near it ─▶ the pixels beside read the bits
//
// A pixel around one beside which something else is seen sees that something itself, so its bit is known.
#include "scene.glsl"
#include "view.glsl"
#include "edges.glsl"
#include "visible.glsl"
#include "line_list.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frames { Frame frame; };
#include "grid.glsl"
#include "in_picture.glsl"
#include "placed.glsl"
layout(binding = 7, rg32ui) readonly uniform uimage2D visibility;
layout(binding = 8, rg32ui) readonly uniform uimage2D meshes_and_solids; // in scenes without trims the same
layout(binding = 9, r32ui) readonly uniform uimage2D operand_uv; // in scenes without Boolean solids not read
layout(scalar, binding = 10) buffer Starts { LineList starts; uint start_words[]; };
layout(scalar, binding = 11) buffer CountersBuffer { Counters counters; };

layout(scalar, push_constant) uniform Push { uint capacity; } push;

layout(constant_id = 17) const bool SOLIDS_HAVE_PATCHES = false;

#include "patch.glsl"
#include "patch_place.glsl"
#include "refine.glsl"
#include "fold_near.glsl"
#include "fold_beside.glsl"

const int FOLD_ROWS = 16;    // of a thread
const int FOLD_COLUMNS = 62; // of a workgroup: those of its other two threads belong to workgroups beside it
// Neighbours whose (u, v) differ by no more, of the patch, are on one sheet.
const float SAME_PLACE = 0.05;

bool is_one_place(uvec2 a, uvec2 b) {
    vec2 apart = abs(unpack_uv(a.y) - unpack_uv(b.y));
    return a.x == b.x && max(apart.x, apart.y) <= SAME_PLACE;
}

// Whether the face that a pixel sees may fold so near that it is drawn.
bool may_fold(uvec2 seen, ivec2 around) {
    uint patch_instance = seen.x - 1u;
    FaceInstance fi = face_instance_at(face_instance_of(patch_instance));
    Face face = face_at(fi.face);
    uint n = patch_instance - fi.first_patch_instance;
    Patch patch_ = patch_at(face.first_patch + n);
    ivec2 place = place_of(face, int(n));
    float free = fold_free(face, place, patch_, view_at(fi.instance), unpack_uv(seen.y), vec2(around) + 0.5);
    return patch_.bend != vec3(0.0) && !(free > FOLD_REACH_PX + NEAR_OFF_PX);
}

// Of each column of the workgroup: whether the face that a pixel sees may fold near it; from the row above on, a bit
// each.
shared uint may_fold_in[gl_WorkGroupSize.x];

// The pixels around from which a fold is looked for, a bit each. `may`: whether the faces that they see fold.
uint starts_of(ivec2 at, uint may) {
    uvec2 found[9];
    uint bits = 0u;
    // the pixel itself first
    for (uint n = 0u; n < 9u; ++n) {
        uint k = n == 0u ? 4u : n <= 4u ? n - 1u : n;
        found[n] = patch_seen(beside_pixel(at, k));
        bool known = found[n].x == 0u;
        for (uint i = 0u; i < n; ++i) known = known || is_one_place(found[n], found[i]);
        if (!known) bits |= 1u << k;
        if (known) found[n].x = 0u; // what is not kept is not compared with
    }
    return bits & may;
}

void put_starts(ivec2 at, uint bits) {
    uint count = uint(bitCount(bits));
    uint first = atomicAdd(starts.count, count);
    uint place = first;
    for (uint left = bits; left != 0u; left &= left - 1u) {
        if (place < push.capacity) {
            start_words[LINE_ITEM_WORDS * place] = line_word(at);
            start_words[LINE_ITEM_WORDS * place + 1u] = uint(findLSB(left));
        }
        ++place;
    }
    bool fits = place <= push.capacity;
    if (fits && !begins_group(first, count)) return;
    atomicMax(counters.fold_starts, place);
    if (!fits) atomicOr(counters.failed, FAILED_LINES);
    uvec3 grid = grid_of((min(place, push.capacity) + LINE_GROUP - 1u) / LINE_GROUP);
    for (uint axis = 0u; axis < 3u; ++axis) atomicMax(starts.grid[axis], grid[axis]);
}

// The rows of a column beside whose pixels something else is seen, from the row above `top` on: a bit each.
uint mixed_rows(int column, int top) {
    if (column < 0 || column >= int(frame.size.x)) return 0u;
    // two rows, the one above and the own one
    uvec2 seen[9];
    for (int k = 0; k < 6; ++k) seen[k + 3] = patch_seen(ivec2(column + k % 3 - 1, top + k / 3 - 2));
    uint rows = 0u;
    for (int row = 0; row < FOLD_ROWS + 2; ++row) {
        for (int k = 0; k < 6; ++k) seen[k] = seen[k + 3];
        for (int k = 0; k < 3; ++k) seen[k + 6] = patch_seen(ivec2(column + k - 1, top + row));
        bool alone = true;
        for (int k = 0; k < 9; ++k) alone = alone && is_one_place(seen[k], seen[4]);
        int y = top + row - 1;
        if (!alone && y >= 0 && y < int(frame.size.y)) rows |= 1u << uint(row);
    }
    return rows;
}

void main() {
    uint thread = gl_LocalInvocationID.x;
    int column = int(gl_WorkGroupID.x) * FOLD_COLUMNS + int(thread) - 1;
    int top = int(gl_WorkGroupID.y) * FOLD_ROWS;
    uint mixed = mixed_rows(column, top);
    uint folds = 0u;
    for (uint left = mixed; left != 0u; left &= left - 1u) {
        ivec2 at = ivec2(column, top + findLSB(left) - 1);
        uvec2 seen = patch_seen(at);
        if (seen.x != 0u && may_fold(seen, at)) folds |= left & -left;
    }
    may_fold_in[thread] = folds;
    barrier();
    if (thread == 0u || thread > uint(FOLD_COLUMNS)) return;
    uvec3 around = uvec3(may_fold_in[thread - 1u], folds, may_fold_in[thread + 1u]);
    uint any_around = around.x | around.y | around.z;
    any_around |= any_around << 1u | any_around >> 1u;
    uint own_rows = (1u << uint(FOLD_ROWS)) - 1u;
    for (uint left = mixed >> 1u & any_around >> 1u & own_rows; left != 0u; left &= left - 1u) {
        uint row = uint(findLSB(left));
        uvec3 rows = around >> row; // the one above, the own one, the one below
        uint may = 0u;
        for (uint k = 0u; k < 9u; ++k) may |= (rows[k % 3u] >> k / 3u & 1u) << k;
        ivec2 at = ivec2(column, top + int(row));
        uint bits = starts_of(at, may);
        if (bits != 0u) put_starts(at, bits);
    }
}
