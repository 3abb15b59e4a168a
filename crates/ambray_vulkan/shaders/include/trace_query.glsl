// Tracing by ray queries, and shading by branches: the twin of trace_pipeline.glsl for compute shaders.
#ifndef TRACE_QUERY_GLSL
#define TRACE_QUERY_GLSL

#include "alpha.glsl"
#include "material.glsl"
#include "shape_ray.glsl"

layout(local_size_x = QUERY_WIDTH, local_size_y = QUERY_HEIGHT) in;
layout(set = 0, binding = 0) uniform accelerationStructureEXT tlas;

Hit trace(uint flags, uint type, Ray ray) {
    rayQueryEXT query;
    rayQueryInitializeEXT(query, tlas, flags, 1u << type, ray.origin, 0.0, ray.direction, ray.t_max);
    while (rayQueryProceedEXT(query)) {
        uint custom_index = rayQueryGetIntersectionInstanceCustomIndexEXT(query, false);
        uint primitive = rayQueryGetIntersectionPrimitiveIndexEXT(query, false);
        uvec2 reference = resolve(custom_index, primitive);
        if (rayQueryGetIntersectionTypeEXT(query, false) == gl_RayQueryCandidateIntersectionTriangleEXT) {
            vec2 uv = rayQueryGetIntersectionBarycentricsEXT(query, false);
            if (MASKED != 0u && accepts_triangle(reference.x, reference.y, uv, ray.seed)) {
                rayQueryConfirmIntersectionEXT(query);
            }
        } else if (SHAPES != 0u) {
            bool committed =
                rayQueryGetIntersectionTypeEXT(query, true) != gl_RayQueryCommittedIntersectionNoneEXT;
            float nearest = committed ? rayQueryGetIntersectionTEXT(query, true) : ray.t_max;
            float t;
            if (hit_shape(reference.x, ray.origin, ray.direction, nearest, t)
                && accepts_shape(reference.x, ray.seed)) {
                rayQueryGenerateIntersectionEXT(query, t);
            }
        }
    }
    uint found = rayQueryGetIntersectionTypeEXT(query, true);
    if (found == gl_RayQueryCommittedIntersectionNoneEXT) {
        return MISS;
    }
    vec2 uv = vec2(0.0);
    if (found == gl_RayQueryCommittedIntersectionTriangleEXT) {
        uv = rayQueryGetIntersectionBarycentricsEXT(query, true);
    }
    uvec2 reference = resolve(
        rayQueryGetIntersectionInstanceCustomIndexEXT(query, true),
        rayQueryGetIntersectionPrimitiveIndexEXT(query, true));
    return Hit(rayQueryGetIntersectionTEXT(query, true), uv, reference.x, reference.y);
}

Hit trace_closest(uint type, Ray ray) {
    return trace(gl_RayFlagsNoneEXT, type, ray);
}

bool trace_any(uint type, Ray ray) {
    return trace(gl_RayFlagsTerminateOnFirstHitEXT, type, ray).instance != NONE;
}

Shade shade_surface(At at, Hit hit, uint seen) {
    Shade shade = Shade(
        at.instance, hit.triangle, at.uv, at.place.relative_width, at.material, at.object_position, seen,
        vec3(0.0), vec3(0.0));
    shade_kind(Materials(SCENE.materials).at[at.material].kind, shade);
    return shade;
}

#endif
