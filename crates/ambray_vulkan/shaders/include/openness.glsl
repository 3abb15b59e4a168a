// The fuzzy measure of the distance to the first hit (spec §2). Twin of ambray_core::openness.
#ifndef OPENNESS_GLSL
#define OPENNESS_GLSL

#include "maths.glsl"

// The measure for a first hit at distance d, FAR for a miss.
float openness_at(float d, float radius, float reach, float exponent, float sigma) {
    if (d >= reach) {
        return 1.0;
    }
    switch (FALLOFF) {
        case FALLOFF_POWER: return exponent == 1.0 ? d / radius : pow(d / radius, exponent);
        case FALLOFF_EXPONENTIAL: return -expm1(-sigma * d);
        case FALLOFF_EXPONENTIAL_TRUNCATED: return expm1(-sigma * d) / expm1(-sigma * radius);
        default: return 0.0;
    }
}

#endif
