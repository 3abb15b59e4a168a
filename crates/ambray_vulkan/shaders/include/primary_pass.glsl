// Pass 1, first part: what each pixel sees.
#ifndef PRIMARY_PASS_GLSL
#define PRIMARY_PASS_GLSL

#include "camera.glsl"
#include "previous.glsl"
#include "sampling.glsl"

void write_nothing(uint index) {
    if (TEMPORAL != 0u) {
        Plane(VIEW.temporal.then_positions).at[index] = vec4(0.0);
        Plane(VIEW.temporal.then_normals).at[index] = vec4(0.0);
    }
    Plane(VIEW.positions).at[index] = vec4(0.0, 0.0, 0.0, FAR);
    Plane(VIEW.geometric).at[index] = vec4(0.0);
    Plane(VIEW.shading).at[index] = vec4(vec3(0.0), uintBitsToFloat(NONE));
    Plane(VIEW.smooth_normals).at[index] = vec4(vec3(0.0), uintBitsToFloat(NONE));
    Plane(VIEW.albedo).at[index] = vec4(0.0);
    Plane(VIEW.emission).at[index].rgb = VIEW.background;
}

// Where the point was in the last frame, and its normal there on the side that was seen. `normal` is the one now.
void write_then(uint index, At at, vec3 normal) {
    vec3 position = at.position;
    if (VIEW.temporal.scene_moved != 0u && VIEW.temporal.has_earlier != 0u && motion_of(at.instance) != MOTION_STATIC) {
        position = previous_position(at);
        vec3 seen = VIEW.temporal.orthographic != 0u ? VIEW.temporal.forward : position - VIEW.temporal.eye;
        vec3 geometric = previous_geometric_normal(at, normal);
        normal = NORMALS == NORMALS_GEOMETRIC ? geometric : previous_normal(at, normal);
        normal = towards(normal, dot(geometric, seen) > 0.0 ? -geometric : geometric);
    }
    Plane(VIEW.temporal.then_positions).at[index] = vec4(position, 0.0);
    Plane(VIEW.temporal.then_normals).at[index] = vec4(normal, 0.0);
}

void write_surface(uint index, Ray ray, Hit hit) {
    float width = pixel_footprint(view_depth(ray.origin + hit.t * ray.direction));
    At at = at_hit(ray.origin, ray.direction, hit, width);
    Shade shade = shade_surface(at, hit, 1u);

    vec3 geometric_normal = at.geometric_normal;
    vec3 smooth_normal = is_shape(hit.instance) ? geometric_normal : vertex_normal(at, geometric_normal);
    vec3 bent_normal = shading_normal(at, smooth_normal);
    // Towards the viewer; the shading normal goes with the smooth one, so that it never jumps to the other side.
    geometric_normal = towards(geometric_normal, -ray.direction);
    if (dot(smooth_normal, geometric_normal) < 0.0) {
        smooth_normal = -smooth_normal;
        bent_normal = -bent_normal;
    }
    switch (NORMALS) {
        case NORMALS_SHADING: break;
        case NORMALS_SMOOTH: bent_normal = smooth_normal; break;
        default: bent_normal = geometric_normal; smooth_normal = geometric_normal; break;
    }
    if (TEMPORAL != 0u) {
        write_then(index, at, smooth_normal);
    }
    Plane(VIEW.positions).at[index] = vec4(at.position, view_depth(at.position));
    Plane(VIEW.geometric).at[index] = vec4(geometric_normal, at.reach);
    Plane(VIEW.shading).at[index] = vec4(bent_normal, uintBitsToFloat(at.material));
    Plane(VIEW.smooth_normals).at[index] = vec4(smooth_normal, uintBitsToFloat(hit.instance));
    Plane(VIEW.albedo).at[index] = vec4(shade.albedo, 0.0);
    Plane(VIEW.emission).at[index].rgb = shade.emission;
}

void run(uvec2 pixel, uint index) {
    Ray ray = primary_ray(pixel, primary_seed(pixel, VIEW.frame));
    Hit hit = trace_closest(RAY_PRIMARY, ray);
    if (hit.instance == NONE) {
        write_nothing(index);
    } else {
        write_surface(index, ray, hit);
    }
    Plane(VIEW.emission).at[index].a = uintBitsToFloat(sample_class(pixel));
    Plane(VIEW.direct).at[index] = vec4(vec3(0.0), uintBitsToFloat(pixel_hash(pixel, VIEW.frame, VIEW.seed)));
    Tallies(VIEW.tallies).at[index] = Tally(0u, 0u, 0u, 0u, 0u, 0u);
}

#endif
