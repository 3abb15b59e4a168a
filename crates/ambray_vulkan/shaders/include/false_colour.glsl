// Which colours the values of a plane get. Twin of ambray_core::display, its false_colour.rs, scalar.rs and picture.rs.
#ifndef FALSE_COLOUR_GLSL
#define FALSE_COLOUR_GLSL

#include "layout.glsl"

// Where `value` lies from `low` to `high`, in [0, 1]; what is infinitely far is at the end.
float place(float value, float low, float high) {
    if (value >= FAR) {
        return 1.0;
    }
    if (!(high > low)) {
        return 0.0;
    }
    // Halves, because the difference of two large numbers may be none.
    precise float above = 0.5 * value - 0.5 * low;
    precise float all = 0.5 * high - 0.5 * low;
    precise float share = above / all;
    return clamp(share, 0.0, 1.0);
}

// A point within the box from `low` to `high`.
vec3 position_color(vec3 point, vec3 low, vec3 high) {
    precise vec3 size = high - low;
    size = mix(vec3(1.0), size, greaterThan(size, vec3(0.0)));
    precise vec3 share = (point - low) / size;
    return share;
}

vec3 normal_color(vec3 n) {
    precise vec3 half_n = 0.5 * n;
    precise vec3 color = half_n + 0.5;
    return n == vec3(0.0) ? n : color;
}

// A movement to the right and down about grey, relative to the largest one.
vec3 motion_color(vec2 v, float most) {
    precise vec3 share = vec3(v, 0.0) / (2.0 * most);
    precise vec3 color = share + 0.5;
    return color;
}

float palette_channel(float hue, float shift) {
    precise float h = fract(hue + shift);
    precise float wave = 6.0 * h;
    precise float ramp = abs(wave - 3.0) - 1.0;
    return clamp(ramp, 0.0, 1.0);
}

// A colour for the index `id`, neighbours far apart in hue; black for -1.
vec3 palette(float id) {
    if (id < 0.0) {
        return vec3(0.0);
    }
    // Multiplicative hashing (Knuth 1998, vol. 3, §6.4).
    uint hash = uint(id) * 0x9E3779B9u;
    float hue = float(hash >> 8) / 16777216.0;
    precise float step = 0.4 * float((hash >> 3) & 7u) / 7.0;
    precise float value = 0.6 + step;
    vec3 saturated = vec3(
        palette_channel(hue, 0.0), palette_channel(hue, 2.0 / 3.0), palette_channel(hue, 1.0 / 3.0));
    precise vec3 color = saturated * 0.7;
    precise vec3 mixed = vec3(1.0 - 0.7) + color;
    precise vec3 shown = value * mixed;
    return shown;
}

// The byte nearest to the display value: what PNG files hold. NaN becomes 0.
uint byte_of(float value) {
    precise float scaled = value * 255.0;
    precise float rounded = scaled + 0.5;
    return rounded > 0.0 ? uint(min(rounded, 255.0)) : 0u;
}

// Red, green, blue and an opaque alpha, from the lowest byte.
uint packed(vec3 color) {
    return byte_of(color.r) | byte_of(color.g) << 8 | byte_of(color.b) << 16 | 0xff000000u;
}

#endif
