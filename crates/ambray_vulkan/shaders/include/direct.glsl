// Direct light: the sum of E cos V over the lights, with one shadow ray per point and light (spec §4). Twin of
// ambray_core::direct. The including file says how rays are traced.
#ifndef DIRECT_GLSL
#define DIRECT_GLSL

#include "light.glsl"
#include "offset.glsl"
#include "sampling.glsl"
#include "surface.glsl"

struct Receiver {
    vec3 position;
    vec3 geometric_normal;
    vec3 normal;
    float reach;
    uint seed;
};

vec3 ray_origin(vec3 position, vec3 geometric_normal, float reach) {
    return offset_point(
        position, geometric_normal, reach, VIEW.gather.offset_near_zero, VIEW.gather.offset_distance);
}

// Light reflected by a diffuse surface that receives `irradiance`.
vec3 reflected(vec3 albedo, vec3 irradiance) {
    return albedo * irradiance * (1.0 / PI);
}

vec3 direct_irradiance(Receiver receiver, bool shadows, inout uint shadow_rays) {
    vec3 irradiance = vec3(0.0);
    vec3 origin = ray_origin(receiver.position, receiver.geometric_normal, receiver.reach);
    for (uint i = 0u; i < VIEW.gather.light_count; ++i) {
        Incident incident = incident(Lights(VIEW.gather.lights).at[i], receiver.position);
        float cosine = dot(receiver.normal, incident.to_light);
        vec3 arriving = incident.irradiance * cosine;
        // Lights below the geometric horizon never reach a point.
        bool above_horizon = dot(receiver.geometric_normal, incident.to_light) > 0.0;
        if (!(cosine > 0.0 && above_horizon && arriving != vec3(0.0))) {
            continue;
        }
        if (shadows) {
            shadow_rays += 1u;
            if (trace_any(RAY_SHADOW, Ray(origin, incident.reach, incident.to_light, receiver.seed))) {
                continue;
            }
        }
        irradiance += arriving;
    }
    return irradiance;
}

#endif
