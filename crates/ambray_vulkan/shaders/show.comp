#version 460
// A plane of the last frame as a picture: bytes of red, green, blue and alpha, those that a PNG of it has.
#extension GL_GOOGLE_include_directive : require
#include "include/extensions.glsl"
#include "include/boxes.glsl"
#include "include/false_colour.glsl"
#include "include/planes.glsl"
#include "include/tone_map.glsl"

layout(local_size_x = FILTER_WIDTH, local_size_y = FILTER_HEIGHT) in;

uint shade(float t) {
    return DISPLAY.ramp == 0ul ? packed(vec3(t)) : Uints(DISPLAY.ramp).at[byte_of(t)];
}

// The values at the ends of the ramp.
vec2 ramp_ends() {
    if (DISPLAY.has_range != 0u) {
        return DISPLAY.range;
    }
    switch (DISPLAY.plane) {
        case AOV_DEPTH: return vec2(low_corner(DISPLAY.bounds).x, high_corner(DISPLAY.bounds).x);
        case AOV_RAY_COUNT:
        case AOV_HISTORY: return vec2(0.0, max(1.0, high_corner(DISPLAY.bounds).x));
        default: return vec2(0.0, 1.0);
    }
}

uint shown(uvec2 pixel, uint i) {
    vec3 value = plane_value(DISPLAY.plane, pixel, i);
    switch (DISPLAY.plane) {
        case AOV_ALBEDO: return packed(encode(value));
        case AOV_OPENNESS:
        case AOV_OPENNESS_RAW:
        case AOV_DEPTH:
        case AOV_RAY_COUNT:
        case AOV_HISTORY: {
            vec2 ends = ramp_ends();
            return shade(place(value.x, ends.x, ends.y));
        }
        case AOV_POSITION:
            return packed(is_seen(i) ? position_color(value, low_corner(DISPLAY.bounds), high_corner(DISPLAY.bounds)) : vec3(0.0));
        case AOV_GEOMETRIC_NORMAL:
        case AOV_SHADING_NORMAL:
        case AOV_BENT_NORMAL: return packed(normal_color(value));
        case AOV_MATERIAL:
        case AOV_INSTANCE:
        case AOV_SAMPLE_CLASS: return packed(palette(value.x));
        case AOV_MOTION: return packed(motion_color(value.xy, max(LEAST_MOTION, high_corner(DISPLAY.bounds).x)));
        default: return packed(display_color(value, DISPLAY.brightness, DISPLAY.tone_map));
    }
}

layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer Pixels { uint at[]; };

void main() {
    uvec2 pixel = push.origin + gl_GlobalInvocationID.xy;
    if (any(greaterThanEqual(pixel, VIEW.size)) || any(greaterThanEqual(gl_GlobalInvocationID.xy, push.extent))) {
        return;
    }
    uint i = pixel.y * VIEW.size.x + pixel.x;
    Pixels(VIEW.outputs).at[i] = shown(pixel, i);
}
