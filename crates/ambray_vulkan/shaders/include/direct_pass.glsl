// Pass 1, second part: direct light of each pixel.
#ifndef DIRECT_PASS_GLSL
#define DIRECT_PASS_GLSL

#include "direct.glsl"

void run(uvec2 pixel, uint index) {
    if (floatBitsToUint(Plane(VIEW.smooth_normals).at[index].w) == NONE) {
        return;
    }
    vec4 geometric = Plane(VIEW.geometric).at[index];
    uint hash = floatBitsToUint(Plane(VIEW.direct).at[index].w);
    Receiver receiver = Receiver(
        Plane(VIEW.positions).at[index].xyz, geometric.xyz, Plane(VIEW.shading).at[index].xyz, geometric.w,
        ray_seed(hash, NONE));
    uint shadow_rays = 0u;
    vec3 irradiance = direct_irradiance(receiver, true, shadow_rays);
    Plane(VIEW.direct).at[index].rgb = reflected(Plane(VIEW.albedo).at[index].rgb, irradiance);
    Tallies(VIEW.tallies).at[index].direct_shadow_rays = shadow_rays;
}

#endif
