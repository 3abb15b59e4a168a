#version 460
// rays by ray queries.
#extension GL_GOOGLE_include_directive : require
#include "include/extensions.glsl"
#extension GL_EXT_ray_query : require
#include "include/trace_query.glsl"
#include "include/rays_pass.glsl"
#include "include/main_query.glsl"
