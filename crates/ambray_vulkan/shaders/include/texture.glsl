// Texture lookups from tables of texels, filtered here rather than by the sampler of the device, whose weights may have
// 8 bits only: the same albedo on every backend. Twin of ambray_scene::texture.
#ifndef TEXTURE_GLSL
#define TEXTURE_GLSL

#include "scene.glsl"

// The two texels that a coordinate falls between along one axis, and the weight of the second.
struct Taps {
    uvec2 texels;
    float share;
};

// The coordinate of the same texel near the unit interval.
float wrap_reduce(uint wrap, float coordinate) {
    if (!(abs(coordinate) <= FAR)) {
        return 0.0;
    }
    switch (wrap) {
        case WRAP_REPEAT: return coordinate - floor(coordinate);
        case WRAP_MIRROR: return coordinate - 2.0 * floor(0.5 * coordinate);
        default: return clamp(coordinate, -1.0, 2.0);
    }
}

int modulo(int a, int b) {
    int r = a - (a / b) * b;
    return r < 0 ? r + b : r;
}

// Texel that stands for the one at `index`, which may lie outside the image.
uint wrap_texel(uint wrap, int index, int size) {
    switch (wrap) {
        case WRAP_REPEAT: return uint(modulo(index, size));
        case WRAP_MIRROR: {
            int inside = modulo(index, 2 * size);
            return uint(inside < size ? inside : 2 * size - 1 - inside);
        }
        default: return uint(clamp(index, 0, size - 1));
    }
}

Taps taps(float coordinate, uint size, uint wrap, uint filter_kind) {
    float x = wrap_reduce(wrap, coordinate) * float(size);
    if (filter_kind == TEXEL_NEAREST) {
        uint texel = wrap_texel(wrap, int(floor(x)), int(size));
        return Taps(uvec2(texel), 0.0);
    }
    float left = floor(x - 0.5);
    uvec2 texels = uvec2(wrap_texel(wrap, int(left), int(size)), wrap_texel(wrap, int(left) + 1, int(size)));
    return Taps(texels, x - 0.5 - left);
}

vec4 texel(Texture texture_info, ImageLevel level, uint x, uint y) {
    uint bits = Uints(SCENE.texels).at[level.first_texel + y * level.size.x + x];
    uvec4 bytes = uvec4(bits, bits >> 8, bits >> 16, bits >> 24) & 255u;
    vec4 unit = vec4(bytes) / 255.0;
    if (texture_info.srgb != 0u) {
        FloatArray srgb = FloatArray(SCENE.srgb);
        unit.rgb = vec3(srgb.at[bytes.r], srgb.at[bytes.g], srgb.at[bytes.b]);
    }
    return unit;
}

// Loops rather than calls, since compilers copy what is called: one copy of a texel's code is enough.
vec4 at_level(Texture texture_info, uint number, uint filter_kind, vec2 uv) {
    ImageLevel level = Levels(SCENE.levels).at[texture_info.first_level + number];
    Taps u = taps(uv.x, level.size.x, texture_info.wrap.x, filter_kind);
    Taps v = taps(uv.y, level.size.y, texture_info.wrap.y, filter_kind);
    uint side = filter_kind == TEXEL_NEAREST ? 1u : 2u;
    vec4 rows[2];
    rows[1] = vec4(0.0);
    for (uint y = 0u; y < side; ++y) {
        vec4 left = vec4(0.0);
        for (uint x = 0u; x < side; ++x) {
            vec4 read = texel(texture_info, level, u.texels[x], v.texels[y]);
            left = x == 0u ? read : mix(left, read, u.share);
        }
        rows[y] = left;
    }
    return side == 1u ? rows[0] : mix(rows[0], rows[1], v.share);
}

// Linear RGBA at `uv` for a footprint of `width` texture units.
vec4 sample_texture(uint number, vec2 uv, float width) {
    Texture texture_info = Textures(SCENE.textures).at[number];
    uvec2 full = Levels(SCENE.levels).at[texture_info.first_level].size;
    float texels_wide = width * sqrt(float(full.x) * float(full.y));
    uint filter_kind = texture_info.mag;
    uint fine = 0u;
    float share = 0.0;
    if (texels_wide > 1.0) {
        filter_kind = texture_info.min;
        float level = min(log2(texels_wide), float(texture_info.level_count - 1u));
        if (texture_info.mip == TEXEL_NEAREST) {
            fine = uint(level + 0.5);
        } else if (texture_info.mip == TEXEL_LINEAR) {
            fine = uint(level);
            share = fract(level);
        }
    }
    vec4 color = vec4(0.0);
    uint levels = share == 0.0 ? 1u : 2u;
    for (uint i = 0u; i < levels; ++i) {
        vec4 read = at_level(texture_info, min(fine + i, texture_info.level_count - 1u), filter_kind, uv);
        color = i == 0u ? read : mix(color, read, share);
    }
    return color;
}

// Alpha at `uv` of the full image, magnified.
float texture_alpha(uint number, vec2 uv) {
    Texture texture_info = Textures(SCENE.textures).at[number];
    return at_level(texture_info, 0u, texture_info.mag, uv).a;
}

#endif
