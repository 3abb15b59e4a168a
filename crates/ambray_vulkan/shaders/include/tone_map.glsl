// From linear radiance to display values. Twin of ambray_core::display, its tone_map.rs: products and sums are not fused, so
// that pictures have the bytes of those of the host.
#ifndef TONE_MAP_GLSL
#define TONE_MAP_GLSL

#include "layout.glsl"

// Radiance beyond this is cut, so that infinities stay out of the formulas.
const float BRIGHTEST = 1e30;

// `x` without negative parts, infinities and NaN.
float finite_part(float x) {
    return x > 0.0 ? min(x, BRIGHTEST) : 0.0;
}

vec3 finite_color(vec3 color) {
    return vec3(finite_part(color.r), finite_part(color.g), finite_part(color.b));
}

float srgb(float x) {
    precise float dark = 12.92 * x;
    precise float root = 1.055 * pow(x, 1.0 / 2.4);
    precise float light = root - 0.055;
    return x <= 0.0031308 ? dark : light;
}

// The sRGB transfer function (IEC 61966-2-1) alone; brighter is clipped.
vec3 encode(vec3 linear) {
    vec3 x = min(finite_color(linear), vec3(1.0));
    return vec3(srgb(x.r), srgb(x.g), srgb(x.b));
}

// Khronos PBR Neutral tone mapper (Khronos Group 2024); names as there.
vec3 neutral(vec3 color) {
    const float F90 = 0.04;
    const float START_COMPRESSION = 0.8 - F90;
    const float DESATURATION = 0.15;
    const float D = 1.0 - START_COMPRESSION;

    float x = min(min(color.r, color.g), color.b);
    precise float square = x * x / (4.0 * F90);
    precise float dark = x - square;
    precise vec3 shifted = color - (x < 2.0 * F90 ? dark : F90);
    float peak = max(max(shifted.r, shifted.g), shifted.b);
    if (peak < START_COMPRESSION) {
        return shifted;
    }
    precise float beyond = peak + D - START_COMPRESSION;
    precise float compressed = D * D / beyond;
    precise float new_peak = 1.0 - compressed;
    precise float scale = new_peak / peak;
    precise vec3 scaled = shifted * scale;
    precise float excess = DESATURATION * (peak - new_peak);
    precise float g = 1.0 - 1.0 / (excess + 1.0);
    precise vec3 kept = scaled * (1.0 - g);
    precise float white = new_peak * g;
    precise vec3 mixed = kept + white;
    return mixed;
}

// Display value in [0, 1] of linear `radiance`; `brightness` is 2 to the power of the exposure.
vec3 display_color(vec3 radiance, float brightness, uint tone_map) {
    precise vec3 exposed = finite_color(radiance) * brightness;
    return encode(tone_map == TONE_NEUTRAL ? neutral(min(exposed, vec3(BRIGHTEST))) : exposed);
}

#endif
