// Where things are in the picture of the last frame. Twin of ambray_core::camera::Camera::project.
#ifndef EARLIER_GLSL
#define EARLIER_GLSL

#include "scene.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) buffer Frames { float at[]; };

#define TEMPORAL_VIEW VIEW.temporal

// View depth and size of a pixel there, in the last frame.
vec2 earlier_depth(vec3 point) {
    float depth = dot(point - TEMPORAL_VIEW.eye, TEMPORAL_VIEW.forward);
    float pixel = TEMPORAL_VIEW.half_height / (0.5 * float(VIEW.size.y));
    return vec2(depth, TEMPORAL_VIEW.orthographic != 0u ? pixel : depth * pixel);
}

// Pixels from the centre of pixel (0, 0) to the right and down; `footprint` is the size of a pixel at the point.
vec2 earlier_place(vec3 point, float footprint) {
    vec2 size = vec2(VIEW.size);
    vec3 offset = point - TEMPORAL_VIEW.eye;
    return vec2(
        dot(offset, TEMPORAL_VIEW.right) / footprint + 0.5 * (size.x - 1.0),
        0.5 * (size.y - 1.0) - dot(offset, TEMPORAL_VIEW.up) / footprint);
}

#endif
