// Boxes that many invocations grow at once: the lowest corner and the negated highest one, as bits whose order is that of the
// numbers, so that one atomic minimum does for all of it and a word with all bits set is empty.
#ifndef BOXES_GLSL
#define BOXES_GLSL

#include "scene.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Words { uint at[]; };

uint ordered(float x) {
    uint bits = floatBitsToUint(x);
    return (bits >> 31) == 1u ? ~bits : bits | 0x80000000u;
}

float unordered(uint bits) {
    return uintBitsToFloat((bits >> 31) == 1u ? bits & 0x7fffffffu : ~bits);
}

void grow(uint64_t box, vec3 low, vec3 high) {
    for (int axis = 0; axis < 3; ++axis) {
        atomicMin(Words(box).at[axis], ordered(low[axis]));
        atomicMin(Words(box).at[3 + axis], ordered(-high[axis]));
    }
}

vec3 low_corner(uint64_t box) {
    Words words = Words(box);
    return vec3(unordered(words.at[0]), unordered(words.at[1]), unordered(words.at[2]));
}

vec3 high_corner(uint64_t box) {
    Words words = Words(box);
    return -vec3(unordered(words.at[3]), unordered(words.at[4]), unordered(words.at[5]));
}

#endif
