// What travels with a ray through the ray-tracing pipeline.
#ifndef PAYLOAD_GLSL
#define PAYLOAD_GLSL

struct Payload {
    float t;
    vec2 uv;
    // NONE on a miss.
    uint custom_index;
    uint primitive;
    // Randomness for stochastic transparency, read by the any-hit shaders.
    uint seed;
};

#endif
