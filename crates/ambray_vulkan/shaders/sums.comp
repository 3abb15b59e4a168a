#version 460
// Rays of all pixels, by type: ambient, chords, shadow rays. Sums of 64 bits, each as two words, to which workgroups add.
#extension GL_GOOGLE_include_directive : require
#include "include/extensions.glsl"
#include "include/boxes.glsl"

layout(local_size_x = REDUCE_WIDTH) in;

shared uint64_t ambient[REDUCE_WIDTH];
shared uint64_t chord[REDUCE_WIDTH];
shared uint64_t shadow[REDUCE_WIDTH];

// Adds to the sum at this index. The low word wraps around in one invocation, which carries.
void add(uint index, uint64_t value) {
    uint low = uint(value & 0xfffffffful);
    uint before = atomicAdd(Words(VIEW.outputs).at[2u * index], low);
    uint carry = before + low < before ? 1u : 0u;
    atomicAdd(Words(VIEW.outputs).at[2u * index + 1u], uint(value >> 32) + carry);
}

void main() {
    uint local = gl_LocalInvocationIndex;
    uint64_t rays = 0ul;
    uint64_t chords = 0ul;
    uint64_t shadows = 0ul;
    for (uint i = gl_GlobalInvocationID.x; i < VIEW.count; i += push.extent.x) {
        Tally tally = Tallies(VIEW.tallies).at[i];
        rays += uint64_t(tally.ambient_rays);
        chords += uint64_t(tally.chord_rays);
        shadows += uint64_t(tally.direct_shadow_rays) + uint64_t(tally.shadow_rays);
    }
    ambient[local] = rays;
    chord[local] = chords;
    shadow[local] = shadows;
    for (uint stride = REDUCE_WIDTH / 2u; stride > 0u; stride /= 2u) {
        barrier();
        if (local < stride) {
            ambient[local] += ambient[local + stride];
            chord[local] += chord[local + stride];
            shadow[local] += shadow[local + stride];
        }
    }
    if (local == 0u) {
        add(0u, ambient[0]);
        add(1u, chord[0]);
        add(2u, shadow[0]);
    }
}
