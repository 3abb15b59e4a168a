// Texture lookups from tables of texels, filtered here rather than by the sampler of the device, whose weights may have
// 8 bits only: the same albedo on every backend. Twin of ambray_scene::texture.
#ifndef TEXTURE_GLSL
#define TEXTURE_GLSL

#include "scene.glsl"

// The two texels that a coordinate falls between along one axis, and the weight of the second.
struct Taps {
    uint first;
    uint second;
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
        return Taps(texel, texel, 0.0);
    }
    float left = floor(x - 0.5);
    uint first = wrap_texel(wrap, int(left), int(size));
    uint second = wrap_texel(wrap, int(left) + 1, int(size));
    return Taps(first, second, x - 0.5 - left);
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

vec4 at_level(Texture texture_info, uint number, uint filter_kind, vec2 uv) {
    ImageLevel level = Levels(SCENE.levels).at[texture_info.first_level + number];
    Taps u = taps(uv.x, level.size.x, texture_info.wrap.x, filter_kind);
    Taps v = taps(uv.y, level.size.y, texture_info.wrap.y, filter_kind);
    vec4 corner = texel(texture_info, level, u.first, v.first);
    if (filter_kind == TEXEL_NEAREST) {
        return corner;
    }
    vec4 upper = mix(corner, texel(texture_info, level, u.second, v.first), u.share);
    vec4 lower = mix(
        texel(texture_info, level, u.first, v.second), texel(texture_info, level, u.second, v.second), u.share);
    return mix(upper, lower, v.share);
}

// Linear RGBA at `uv` for a footprint of `width` texture units.
vec4 sample_texture(uint number, vec2 uv, float width) {
    Texture texture_info = Textures(SCENE.textures).at[number];
    uvec2 full = Levels(SCENE.levels).at[texture_info.first_level].size;
    float texels_wide = width * sqrt(float(full.x) * float(full.y));
    if (!(texels_wide > 1.0)) {
        return at_level(texture_info, 0u, texture_info.mag, uv);
    }
    float level = min(log2(texels_wide), float(texture_info.level_count - 1u));
    if (texture_info.mip == NONE) {
        return at_level(texture_info, 0u, texture_info.min, uv);
    }
    if (texture_info.mip == TEXEL_NEAREST) {
        return at_level(texture_info, uint(level + 0.5), texture_info.min, uv);
    }
    uint lower = uint(level);
    float share = fract(level);
    vec4 fine = at_level(texture_info, lower, texture_info.min, uv);
    if (share == 0.0) {
        return fine;
    }
    vec4 coarse = at_level(texture_info, min(lower + 1u, texture_info.level_count - 1u), texture_info.min, uv);
    return mix(fine, coarse, share);
}

// Alpha at `uv` of the full image, magnified.
float texture_alpha(uint number, vec2 uv) {
    Texture texture_info = Textures(SCENE.textures).at[number];
    return at_level(texture_info, 0u, texture_info.mag, uv).a;
}

#endif
