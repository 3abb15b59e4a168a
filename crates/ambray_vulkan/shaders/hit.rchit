#version 460
// Closest hit of all geometry: where it is. The ray generation shader evaluates the surface.
#extension GL_GOOGLE_include_directive : require
#include "include/extensions.glsl"
#extension GL_EXT_ray_tracing : require
#include "include/payload.glsl"

layout(location = 0) rayPayloadInEXT Payload payload;
hitAttributeEXT vec2 uv;

void main() {
    payload.t = gl_HitTEXT;
    payload.uv = uv;
    payload.custom_index = gl_InstanceCustomIndexEXT;
    payload.primitive = gl_PrimitiveID;
}
