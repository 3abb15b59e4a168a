#version 460
// The box around the values of a plane of the last frame, of pixels that see a surface: what ramps go by that span the
// picture. Of movements, the largest part of any.
#extension GL_GOOGLE_include_directive : require
#include "include/extensions.glsl"
#include "include/boxes.glsl"
#include "include/planes.glsl"

layout(local_size_x = REDUCE_WIDTH) in;

// Boxes of the invocations: one for the workgroup goes to memory, since atomics on one address wait for each other.
shared vec3 lows[REDUCE_WIDTH];
shared vec3 highs[REDUCE_WIDTH];

void main() {
    uint local = gl_LocalInvocationIndex;
    uint plane = DISPLAY.plane;
    vec3 low = vec3(FAR);
    vec3 high = vec3(-FAR);
    bool is_count = plane == AOV_RAY_COUNT || plane == AOV_HISTORY;
    for (uint i = gl_GlobalInvocationID.x; i < VIEW.count; i += push.extent.x) {
        uvec2 pixel = uvec2(i % VIEW.size.x, i / VIEW.size.x);
        if (is_count || is_seen(i)) {
            vec3 value = plane_value(plane, pixel, i);
            value = plane == AOV_MOTION ? vec3(max(abs(value.x), abs(value.y))) : value;
            low = min(low, value);
            high = max(high, value);
        }
    }
    lows[local] = low;
    highs[local] = high;
    for (uint stride = REDUCE_WIDTH / 2u; stride > 0u; stride /= 2u) {
        barrier();
        if (local < stride) {
            lows[local] = min(lows[local], lows[local + stride]);
            highs[local] = max(highs[local], highs[local + stride]);
        }
    }
    if (local == 0u) {
        grow(DISPLAY.bounds, lows[0], highs[0]);
    }
}
