#version 460
// primary by ray queries.
#extension GL_GOOGLE_include_directive : require
#include "include/extensions.glsl"
#extension GL_EXT_ray_query : require
#include "include/trace_query.glsl"
#include "include/primary_pass.glsl"
#include "include/main_query.glsl"
