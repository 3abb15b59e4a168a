// The planes of a frame by their names, as the host reads them. Twin of ambray_core::frame::Frame::plane.
#ifndef PLANES_GLSL
#define PLANES_GLSL

#include "compose.glsl"
#include "earlier.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer DisplayReference { Display data; };
#define DISPLAY DisplayReference(VIEW.inputs).data

bool is_seen(uint i) {
    return floatBitsToUint(Plane(VIEW.smooth_normals).at[i].w) != NONE;
}

// Openness and near radiance before the filter.
vec4 raw_ambient(uint i) {
    vec4 raw = Plane(VIEW.ambient).at[i];
    if (AFTER_FILTER != 0u) {
        raw = smaller_batch(raw, Plane(VIEW.second).at[i]);
    }
    return finish(raw, VIEW.gather.ambient);
}

vec3 unit_or_zero(vec3 v) {
    precise float square = v.x * v.x + v.y * v.y + v.z * v.z;
    precise float inverse = 1.0 / sqrt(square);
    precise vec3 scaled = v * inverse;
    return inverse > 0.0 && inverse <= FAR ? scaled : vec3(0.0);
}

float index_value(float bits) {
    uint id = floatBitsToUint(bits);
    return id == NONE ? -1.0 : float(id);
}

// How far the surface point moved since the last frame, pixels to the right and down.
vec2 moved(uvec2 pixel, uint i) {
    if (VIEW.temporal.has_earlier == 0u || !is_seen(i)) {
        return vec2(0.0);
    }
    vec3 then = Plane(VIEW.temporal.then_positions).at[i].xyz;
    float footprint = earlier_depth(then).y;
    return footprint > 0.0 ? vec2(pixel) - earlier_place(then, footprint) : vec2(0.0);
}

float ray_count(uint i) {
    Tally tally = Tallies(VIEW.tallies).at[i];
    return float(1u + tally.ambient_rays + tally.chord_rays + tally.direct_shadow_rays + tally.shadow_rays);
}

// Values of the plane, an AOV constant, at a pixel with the index `i`. Channels that it lacks are 0.
vec3 plane_value(uint plane, uvec2 pixel, uint i) {
    switch (plane) {
        case AOV_BEAUTY: return Plane(VIEW.beauty).at[i].rgb;
        case AOV_OPENNESS: return vec3(Plane(VIEW.filtered).at[i].x, 0.0, 0.0);
        case AOV_OPENNESS_RAW: return vec3(raw_ambient(i).x, 0.0, 0.0);
        case AOV_NEAR_RADIANCE: return Plane(VIEW.filtered).at[i].yzw;
        case AOV_NEAR_RADIANCE_RAW: return raw_ambient(i).yzw;
        case AOV_DIRECT: return Plane(VIEW.direct).at[i].rgb;
        case AOV_ALBEDO: return Plane(VIEW.albedo).at[i].rgb;
        case AOV_EMISSION: return Plane(VIEW.emission).at[i].rgb;
        case AOV_DEPTH: return vec3(is_seen(i) ? Plane(VIEW.positions).at[i].w : FAR, 0.0, 0.0);
        case AOV_POSITION: return Plane(VIEW.positions).at[i].xyz;
        case AOV_GEOMETRIC_NORMAL: return Plane(VIEW.geometric).at[i].xyz;
        case AOV_SHADING_NORMAL: return Plane(VIEW.shading).at[i].xyz;
        case AOV_BENT_NORMAL: return unit_or_zero(Plane(VIEW.filtered_bent).at[i].xyz);
        case AOV_MATERIAL: return vec3(index_value(Plane(VIEW.shading).at[i].w), 0.0, 0.0);
        case AOV_INSTANCE: return vec3(index_value(Plane(VIEW.smooth_normals).at[i].w), 0.0, 0.0);
        case AOV_SAMPLE_CLASS: return vec3(float(floatBitsToUint(Plane(VIEW.emission).at[i].a)), 0.0, 0.0);
        case AOV_RAY_COUNT: return vec3(ray_count(i), 0.0, 0.0);
        case AOV_MOTION: return vec3(moved(pixel, i), 0.0);
        default: // AOV_HISTORY
            return vec3(VIEW.temporal.next.frames == 0ul ? 1.0 : Frames(VIEW.temporal.next.frames).at[i], 0.0, 0.0);
    }
}

#endif
