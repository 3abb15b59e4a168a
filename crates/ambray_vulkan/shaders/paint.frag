// Pixels of the triangles that a window is painted with. Colours are display values throughout: nothing is converted, so
// that a picture at its own size reaches the window byte for byte.
#version 460

layout(set = 0, binding = 0) uniform sampler2D image;

layout(location = 0) in vec2 uv;
layout(location = 1) in vec4 colour;

layout(location = 0) out vec4 pixel;

void main() {
    pixel = colour * texture(image, uv);
}
