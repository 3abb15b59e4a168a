#version 460
// Nothing was hit.
#extension GL_GOOGLE_include_directive : require
#include "include/extensions.glsl"
#extension GL_EXT_ray_tracing : require
#include "include/layout.glsl"
#include "include/payload.glsl"

layout(location = 0) rayPayloadInEXT Payload payload;

void main() {
    payload.custom_index = NONE;
}
