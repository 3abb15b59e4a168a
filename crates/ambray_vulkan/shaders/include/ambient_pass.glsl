// Pass 1, third part: openness, near radiance and bent normal of each pixel or point.
#ifndef AMBIENT_PASS_GLSL
#define AMBIENT_PASS_GLSL

#include "gather.glsl"

void run(uvec2 pixel, uint index) {
    uint instance = floatBitsToUint(Plane(VIEW.smooth_normals).at[index].w);
    if (instance == NONE) {
        Plane(VIEW.ambient).at[index] = vec4(1.0, 0.0, 0.0, 0.0);
        Plane(VIEW.second).at[index] = vec4(1.0, 0.0, 0.0, 0.0);
        Plane(VIEW.bent).at[index] = vec4(0.0);
        return;
    }
    vec4 geometric = Plane(VIEW.geometric).at[index];
    Gathered gathered = gather(ShadedPoint(
        Plane(VIEW.positions).at[index].xyz, geometric.xyz, geometric.w, Plane(VIEW.shading).at[index].xyz,
        floatBitsToUint(Plane(VIEW.emission).at[index].a), floatBitsToUint(Plane(VIEW.direct).at[index].w),
        instance));
    Plane(VIEW.ambient).at[index] = AFTER_FILTER != 0u ? gathered.first : gathered.both;
    Plane(VIEW.second).at[index] = gathered.second;
    Plane(VIEW.bent).at[index] = vec4(gathered.bent, TEMPORAL != 0u ? gathered.changing : gathered.first.x);
    gathered.tally.direct_shadow_rays = Tallies(VIEW.tallies).at[index].direct_shadow_rays;
    Tallies(VIEW.tallies).at[index] = gathered.tally;
}

#endif
