// Ray origins moved off their surface (spec §5). Twin of ambray_core::offset.
#ifndef OFFSET_GLSL
#define OFFSET_GLSL

// Four units of the last place of the triangle's reach.
const float OFFSET_ROUNDING = 4.76837158203125e-7;

float offset_coordinate(float p, float n, float near_zero, float fixed_distance) {
    if (abs(p) < near_zero) {
        return p + n * fixed_distance;
    }
    int of_i = int(256.0 * n);
    return intBitsToFloat(floatBitsToInt(p) + (p < 0.0 ? -of_i : of_i));
}

vec3 offset_point(vec3 p, vec3 n, float reach, float near_zero, float fixed_distance) {
    vec3 published = vec3(
        offset_coordinate(p.x, n.x, near_zero, fixed_distance),
        offset_coordinate(p.y, n.y, near_zero, fixed_distance),
        offset_coordinate(p.z, n.z, near_zero, fixed_distance));
    vec3 rounding = n * (OFFSET_ROUNDING * reach);
    return mix(published, p + rounding, lessThan(abs(published - p), abs(rounding)));
}

#endif
