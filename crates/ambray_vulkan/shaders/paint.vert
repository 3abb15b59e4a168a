// Corners of the triangles that a window is painted with.
#version 460

layout(location = 0) in vec2 corner; // points, from the top left
layout(location = 1) in vec2 corner_uv;
layout(location = 2) in vec4 corner_colour; // premultiplied, display values

layout(push_constant) uniform Push {
    vec2 size; // of the window, points
} push;

layout(location = 0) out vec2 uv;
layout(location = 1) out vec4 colour;

void main() {
    gl_Position = vec4(2.0 * corner / push.size - 1.0, 0.0, 1.0);
    uv = corner_uv;
    colour = corner_colour;
}
