// Elementary functions whose precision Vulkan does not promise.
#ifndef MATHS_GLSL
#define MATHS_GLSL

const float PI = 3.14159265358979;

// exp(x) - 1 for x up to 1/4, without cancellation near 0. Off by less than 1e-6 of the result.
float expm1(float x) {
    if (abs(x) > 0.25) {
        return exp(x) - 1.0;
    }
    return x * (1.0 + x * (1.0 / 2.0 + x * (1.0 / 6.0 + x * (1.0 / 24.0 + x * (1.0 / 120.0 + x * (1.0 / 720.0))))));
}

// Cosine and sine of 2 pi v for v in [0, 1]: Taylor series over an eighth of a turn, off by less than 2e-7.
vec2 turn(float v) {
    float quarter = floor(4.0 * v + 0.5);
    float x = (v - 0.25 * quarter) * (2.0 * PI);
    float xx = x * x;
    float c = 1.0 + xx * (-1.0 / 2.0 + xx * (1.0 / 24.0 + xx * (-1.0 / 720.0 + xx * (1.0 / 40320.0))));
    float s = x * (1.0 + xx * (-1.0 / 6.0 + xx * (1.0 / 120.0 + xx * (-1.0 / 5040.0 + xx * (1.0 / 362880.0)))));
    switch (int(quarter) & 3) {
        case 0: return vec2(c, s);
        case 1: return vec2(-s, c);
        case 2: return vec2(-c, -s);
        default: return vec2(s, -c);
    }
}

#endif
