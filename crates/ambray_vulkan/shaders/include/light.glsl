// Lights that reach a point from one direction (spec §4). Twin of ambray_core::light.
#ifndef LIGHT_GLSL
#define LIGHT_GLSL

#include "scene.glsl"

// Light arriving at a point, before visibility and the cosine of the surface.
struct Incident {
    vec3 to_light;
    float reach;
    vec3 irradiance;
};

// Share of the intensity of a spot light along the unit vector `direction` (KHR_lights_punctual).
float cone_factor(Light light, vec3 direction) {
    float scale = 1.0 / max(light.cos_inner - light.cos_outer, 0.001);
    float x = clamp((dot(light.axis, direction) - light.cos_outer) * scale, 0.0, 1.0);
    return x * x;
}

// Smooth window that brings a point light to zero at its range (KHR_lights_punctual).
float range_window(float d, float range) {
    float square = (d / range) * (d / range);
    return range < FAR ? clamp(1.0 - square * square, 0.0, 1.0) : 1.0;
}

Incident incident(Light light, vec3 point) {
    if (light.kind == LIGHT_DIRECTIONAL) {
        return Incident(light.place, FAR, light.strength);
    }
    vec3 offset = light.place - point;
    float d = length(offset);
    if (!(d > 0.0)) {
        return Incident(vec3(0.0), 0.0, vec3(0.0));
    }
    vec3 to_light = offset / d;
    float cone = light.kind == LIGHT_SPOT ? cone_factor(light, -to_light) : 1.0;
    return Incident(to_light, d, light.strength * (range_window(d, light.range) / (d * d) * cone));
}

#endif
