// Sample sets (spec §6) and the hemisphere warp (spec §1). Twin of ambray_core::sampling.
#ifndef SAMPLING_GLSL
#define SAMPLING_GLSL

#include "maths.glsl"
#include "scene.glsl"

const uint CLASS_TABLE[16] = uint[](1, 8, 3, 10, 12, 5, 14, 7, 2, 11, 0, 9, 15, 6, 13, 4);

uint sample_class(uvec2 pixel) {
    return CLASS_TABLE[(pixel.y & 3u) * 4u + (pixel.x & 3u)];
}

// PCG-RXS-M-XS (O'Neill 2014).
uint pcg(uint v) {
    uint s = v * 747796405u + 2891336453u;
    uint w = ((s >> ((s >> 28) + 4u)) ^ s) * 277803737u;
    return (w >> 22) ^ w;
}

// 32 random bits to [0, 1) in steps of 2^-24, exactly.
float unit_float(uint x) {
    return float(x >> 8) * (1.0 / 16777216.0);
}

uint sobol1(uint i) {
    uint r = 0u;
    for (uint v = 1u << 31; i != 0u; i >>= 1, v ^= v >> 1) {
        if ((i & 1u) != 0u) {
            r ^= v;
        }
    }
    return r;
}

// Hash-based Owen scrambling (Burley 2020).
uint owen(uint x, uint seed) {
    x = bitfieldReverse(x) + seed;
    x ^= x * 0x6c50b47cu;
    x ^= x * 0xb82f1e52u;
    x ^= x * 0xc7afe638u;
    x ^= x * 0x8d22f6e6u;
    return bitfieldReverse(x);
}

uvec2 owen_point(uint i, uvec2 seeds) {
    return uvec2(owen(bitfieldReverse(i), seeds.x), owen(sobol1(i), seeds.y));
}

// The R2 sequence (Roberts 2018).
uvec2 r2_point(uint i, uvec2 seeds) {
    return seeds + i * uvec2(3242174889u, 2447445414u);
}

// Two independent seeds from one hash.
uvec2 seed_pair(uint hash) {
    uint first = pcg(hash);
    return uvec2(first, pcg(first ^ 0x9e3779b9u));
}

uint pixel_hash(uvec2 pixel, uint frame, uint seed) {
    return pcg(pixel.x + pcg(pixel.y + pcg(frame + pcg(seed))));
}

// Seed of primary rays: the 16 pixels of a block share the hash and differ in the stratum.
uint primary_seed(uvec2 pixel, uint frame) {
    return (pixel_hash(pixel >> 2, frame, 0u) << 4) | sample_class(pixel);
}

uint ray_seed(uint hash, uint ray) {
    return pcg(hash ^ pcg(ray));
}

// Threshold against which a blended triangle compares its alpha (ambray_core::trace::alpha_threshold).
float alpha_threshold(uint seed, uint instance, uint triangle) {
    float stratum = (float(seed & 15u) + 0.5) / 16.0;
    uint layer = pcg(pcg(pcg(seed >> 4) ^ instance) ^ triangle);
    return fract(stratum + unit_float(layer));
}

// Cosine-weighted direction (t, b, n) with its azimuth in w.
vec4 direction_from_bits(uvec2 bits) {
    vec2 xi = vec2(unit_float(bits.x), unit_float(bits.y));
    return vec4(sqrt(xi.x) * turn(xi.y), sqrt(1.0 - xi.x), xi.y);
}

// Direction number j < SPP of a pixel, and its azimuth in w.
vec4 sample_direction(uint sample_set, uint hash, uint j) {
    switch (SAMPLING) {
        case SAMPLING_INTERLEAVED: return Vec4s(VIEW.gather.directions).at[sample_set * SPP + j];
        case SAMPLING_SAME: return Vec4s(VIEW.gather.directions).at[j];
        case SAMPLING_RANDOM: {
            uvec2 seeds = seed_pair(hash);
            return direction_from_bits(SEQUENCE == SEQUENCE_R2 ? r2_point(j, seeds) : owen_point(j, seeds));
        }
        default: return direction_from_bits(seed_pair(ray_seed(hash, j)));
    }
}

#endif
