// Lists of lines, for the passes over them. The includer declares `frame`, `push.capacity`, and defines LISTS_BINDING.
#ifndef LINE_ITEMS_GLSL
#define LINE_ITEMS_GLSL

#include "line_list.glsl"
#include "grid.glsl"

layout(local_size_x = 64) in;
#include "thread.glsl"

layout(scalar, binding = LISTS_BINDING) buffer Lists {
    LineList list;
    uint words[];
};

uint items_of_step() { return LINE_STEP == STEP_FOUND ? list.found_count : min(list.count, push.capacity); }

// Pixel, and what is looked for there.
uvec2 item_at(uint i) { return uvec2(words[LINE_ITEM_WORDS * i], words[LINE_ITEM_WORDS * i + 1u]); }

uint found_word(uint i) { return LINE_ITEM_WORDS * push.capacity + FOUND_WORDS * i; }

Found found_at(uint i) {
    uint at = found_word(i);
    vec3 from_eye = uintBitsToFloat(uvec3(words[at + 5u], words[at + 6u], words[at + 7u]));
    vec2 place = uintBitsToFloat(uvec2(words[at + 3u], words[at + 4u]));
    return Found(words[at], words[at + 1u], words[at + 2u], place, from_eye, uintBitsToFloat(words[at + 8u]));
}

void put_found(Found f) {
    uint i = atomicAdd(list.found_count, 1u);
    uint at = found_word(i);
    uint all[FOUND_WORDS] = uint[](
        f.pixel, f.what, f.steps, floatBitsToUint(f.place.x), floatBitsToUint(f.place.y), floatBitsToUint(f.from_eye.x),
        floatBitsToUint(f.from_eye.y), floatBitsToUint(f.from_eye.z), floatBitsToUint(f.off)
    );
    for (uint k = 0u; k < FOUND_WORDS; ++k) words[at + k] = all[k];
    if (!begins_group(i, 1u)) return;
    uvec3 grid = grid_of(i / LINE_GROUP + 1u);
    for (uint axis = 0u; axis < 3u; ++axis) atomicMax(list.found_grid[axis], grid[axis]);
}

#endif
