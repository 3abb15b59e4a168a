// Final radiance L = emission + a (L_a O + I) + direct light (spec §4). Twin of ambray_core::compose.
#ifndef COMPOSE_GLSL
#define COMPOSE_GLSL

#include "scene.glsl"

// F = O / (1 - a (1 - O)) in [0, 1], given near = a (1 - O). Nothing glows where nothing is open.
vec3 self_similar_factor(float openness, vec3 near) {
    return openness > 0.0 ? openness / max(vec3(1.0) - near, vec3(openness)) : vec3(0.0);
}

// Openness (x) with the finished near radiance (yzw): the self-similar bounce is completed after the filter (spec §3).
vec4 finish(vec4 gathered, vec3 ambient) {
    if (SOURCE != SOURCE_SELF_SIMILAR) {
        return gathered;
    }
    return vec4(gathered.x, gathered.yzw * ambient * self_similar_factor(gathered.x, gathered.yzw));
}

// Of two batches, the one with the smaller openness (spec §8).
vec4 smaller_batch(vec4 first, vec4 second) {
    return second.x < first.x ? second : first;
}

vec3 compose(vec3 emission, vec3 albedo, vec3 ambient, vec4 gathered, vec3 direct) {
    return emission + albedo * (ambient * gathered.x + gathered.yzw) + direct;
}

#endif
