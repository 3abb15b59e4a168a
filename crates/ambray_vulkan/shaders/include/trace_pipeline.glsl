// Tracing and shading through the ray-tracing pipeline: hit groups, miss and callable shaders.
#ifndef TRACE_PIPELINE_GLSL
#define TRACE_PIPELINE_GLSL

#include "material.glsl"
#include "payload.glsl"

layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;
layout(location = 0) rayPayloadEXT Payload payload;
layout(location = 1) callableDataEXT Shade callable;

Hit trace_closest(uint type, Ray ray) {
    payload.seed = ray.seed;
    traceRayEXT(tlas, gl_RayFlagsNoneEXT, 1u << type, type, RAY_TYPES, type, ray.origin, 0.0, ray.direction, ray.t_max, 0);
    if (payload.custom_index == NONE) {
        return MISS;
    }
    uvec2 reference = resolve(payload.custom_index, payload.primitive);
    return Hit(payload.t, payload.uv, reference.x, reference.y);
}

bool trace_any(uint type, Ray ray) {
    payload.seed = ray.seed;
    // Blocked unless the miss shader says otherwise.
    payload.custom_index = 0u;
    uint flags = gl_RayFlagsTerminateOnFirstHitEXT | gl_RayFlagsSkipClosestHitShaderEXT;
    traceRayEXT(tlas, flags, 1u << type, type, RAY_TYPES, type, ray.origin, 0.0, ray.direction, ray.t_max, 0);
    return payload.custom_index != NONE;
}

// Colours of a surface by the callable shader of its material's kind.
Shade shade_surface(At at, Hit hit, uint seen) {
    callable = Shade(
        at.instance, hit.triangle, at.uv, at.place.relative_width, at.material, at.object_position, seen,
        vec3(0.0), vec3(0.0));
    executeCallableEXT(Materials(SCENE.materials).at[at.material].kind, 1);
    return callable;
}

#endif
