// A batch of rays: their hits (ambray_core::trace::Trace).
#ifndef RAYS_PASS_GLSL
#define RAYS_PASS_GLSL

#include "surface.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 4) readonly buffer Rays { Ray at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer RayHits { RayHit at[]; };

void run(uvec2 pixel, uint index) {
    Ray ray = Rays(VIEW.inputs).at[index];
    Hit hit = MISS;
    if (VIEW.mode == 0u) {
        hit = trace_closest(RAY_AMBIENT, ray);
    } else if (trace_any(RAY_SHADOW, ray)) {
        hit.instance = 0u;
    }
    RayHits(VIEW.outputs).at[index] = RayHit(hit.t, hit.uv.x, hit.uv.y, hit.instance, hit.triangle);
}

#endif
