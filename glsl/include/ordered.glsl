// Numbers as words with the same order. Twins: `ordered_bits` of src/twin/cross.rs, `from_ordered` of src/twin/sort.rs.
#ifndef ORDERED_GLSL
#define ORDERED_GLSL

uint ordered_bits(float u) {
    uint bits = floatBitsToUint(u);
    return (bits & 0x80000000u) != 0u ? ~bits : bits | 0x80000000u;
}

float from_ordered(uint bits) {
    return uintBitsToFloat((bits & 0x80000000u) != 0u ? bits & 0x7fffffffu : ~bits);
}

#endif
