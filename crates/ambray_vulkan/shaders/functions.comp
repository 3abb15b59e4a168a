#version 460
// Single functions over a list of calls, for tests against their twins in Rust. `VIEW.mode` says which function.
#extension GL_GOOGLE_include_directive : require
#include "include/extensions.glsl"
#include "include/basis.glsl"
#include "include/camera.glsl"
#include "include/compose.glsl"
#include "include/light.glsl"
#include "include/material_kind.glsl"
#include "include/offset.glsl"
#include "include/openness.glsl"
#include "include/previous.glsl"
#include "include/sampling.glsl"
#include "include/shape.glsl"
#include "include/texture.glsl"
#include "include/tone_map.glsl"

layout(local_size_x = QUERY_WIDTH, local_size_y = QUERY_HEIGHT) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Values { uint at[]; };

// The call of this invocation.
uint call;

uint word(uint i) {
    return Uints(VIEW.inputs).at[call * ARGUMENTS + i];
}

float number(uint i) {
    return uintBitsToFloat(word(i));
}

vec3 vector(uint i) {
    return vec3(number(i), number(i + 1u), number(i + 2u));
}

vec4 vector4(uint i) {
    return vec4(vector(i), number(i + 3u));
}

void put(uint i, uint value) {
    Values(VIEW.outputs).at[call * VALUES + i] = value;
}

void put(uint i, float value) {
    put(i, floatBitsToUint(value));
}

void put(uint i, vec3 value) {
    put(i, value.x);
    put(i + 1u, value.y);
    put(i + 2u, value.z);
}

void put(uint i, vec4 value) {
    put(i, value.xyz);
    put(i + 3u, value.w);
}

void integers() {
    uvec2 seeds = uvec2(word(1u), word(2u));
    uvec2 owen_pair = owen_point(word(0u), seeds);
    uvec2 r2_pair = r2_point(word(0u), seeds);
    put(0u, pcg(word(0u)));
    put(1u, sobol1(word(0u)));
    put(2u, owen(word(0u), word(1u)));
    put(3u, owen_pair.x);
    put(4u, owen_pair.y);
    put(5u, r2_pair.x);
    put(6u, r2_pair.y);
    put(7u, unit_float(word(0u)));
}

void pixels() {
    uvec2 pixel = uvec2(word(0u), word(1u));
    uint hash = pixel_hash(pixel, word(2u), word(3u));
    put(0u, sample_class(pixel));
    put(1u, hash);
    put(2u, primary_seed(pixel, word(2u)));
    put(3u, ray_seed(hash, word(4u)));
}

void basis() {
    mat3 columns = basis_from_normal(vector(0u));
    put(0u, columns[0]);
    put(3u, columns[1]);
}

void light() {
    Incident arriving = incident(Lights(VIEW.gather.lights).at[word(0u)], vector(1u));
    put(0u, arriving.to_light);
    put(3u, arriving.reach);
    put(4u, arriving.irradiance);
}

void camera() {
    Ray ray = primary_ray(uvec2(word(0u), word(1u)), 0u);
    put(0u, ray.origin);
    put(3u, ray.direction);
    put(6u, view_depth(vector(2u)));
    put(7u, pixel_footprint(number(5u)));
}

void texture_value() {
    vec2 uv = vec2(number(1u), number(2u));
    put(0u, sample_texture(word(0u), uv, number(3u)));
    put(4u, texture_alpha(word(0u), uv));
}

void shape_ray() {
    float t;
    bool hit = shape_intersect(Shapes(SCENE.shapes).at[word(0u)], vector(1u), vector(4u), number(7u), t);
    put(0u, hit ? 1u : 0u);
    put(1u, t);
}

void shape_surface() {
    Shape shape = Shapes(SCENE.shapes).at[word(0u)];
    put(0u, shape_normal(shape, vector(1u)));
    put(3u, shape_project(shape, vector(1u)));
}

// Of a point of a mesh or, with an instance beyond them, of a shape at a point of its space.
void previous() {
    At at;
    at.instance = word(0u);
    at.uv = vec2(number(2u), number(3u));
    at.object_position = vec3(number(4u), number(5u), number(6u));
    if (!is_shape(at.instance)) {
        at.place = place_in_mesh(at.instance, word(1u), at.uv, 0.0);
    }
    put(0u, previous_position(at));
    put(3u, previous_normal(at, vec3(0.0)));
}

void main() {
    // The size of the view is the camera's.
    call = gl_GlobalInvocationID.y * push.extent.x + gl_GlobalInvocationID.x;
    if (any(greaterThanEqual(gl_GlobalInvocationID.xy, push.extent)) || call >= VIEW.count) {
        return;
    }
    switch (VIEW.mode) {
        case FUNCTION_INTEGERS: integers(); break;
        case FUNCTION_PIXELS: pixels(); break;
        case FUNCTION_ALPHA: put(0u, alpha_threshold(word(0u), word(1u), word(2u))); break;
        case FUNCTION_SAMPLES: put(0u, sample_direction(word(0u), word(1u), word(2u))); break;
        case FUNCTION_BASIS: basis(); break;
        case FUNCTION_OPENNESS:
            put(0u, openness_at(number(0u), number(1u), number(2u), number(3u), number(4u)));
            put(1u, expm1(number(5u)));
            break;
        case FUNCTION_OFFSET: put(0u, offset_point(vector(0u), vector(3u), number(6u), number(7u), number(8u))); break;
        case FUNCTION_LIGHT: light(); break;
        case FUNCTION_CAMERA: camera(); break;
        case FUNCTION_TEXTURE: texture_value(); break;
        case FUNCTION_CHECKER:
            put(0u, checker_color(vec3(1.0, 0.0, 0.0), vec3(0.0, 1.0, 0.0), number(0u), vector(1u)));
            break;
        case FUNCTION_SHAPE_RAY: shape_ray(); break;
        case FUNCTION_SHAPE_SURFACE: shape_surface(); break;
        case FUNCTION_FINISH:
            put(0u, finish(smaller_batch(vector4(0u), vector4(4u)), vector(8u)));
            put(4u, self_similar_factor(number(0u), vector(1u)));
            break;
        case FUNCTION_COMPOSE:
            put(0u, compose(vector(0u), vector(3u), vector(6u), vector4(9u), vector(13u)));
            break;
        case FUNCTION_PREVIOUS: previous(); break;
        case FUNCTION_TONE_MAP:
            put(0u, display_color(vector(0u), number(3u), word(4u)));
            put(3u, neutral(vector(0u)));
            break;
    }
}
