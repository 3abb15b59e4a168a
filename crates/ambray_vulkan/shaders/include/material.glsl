// Shading by kind of material: what the callable shaders compute. Ray queries branch instead.
#ifndef MATERIAL_GLSL
#define MATERIAL_GLSL

#include "attributes.glsl"
#include "material_kind.glsl"

// In: a surface; out: its colours, linear RGB.
struct Shade {
    uint instance;
    uint triangle;
    vec2 uv;
    float relative_width;
    uint material;
    vec3 object_position;
    // 1 where the camera sees the surface, 0 where light bounces off it: then the emission does not matter.
    uint seen;
    vec3 albedo;
    vec3 emission;
};

vec3 shade_textured(Shade shade, Material material, vec3 color) {
    if (is_shape(shade.instance)) {
        return color;
    }
    Place place = place_in_mesh(shade.instance, shade.triangle, shade.uv, shade.relative_width);
    return textured(place, material, color);
}

vec3 shade_emission(Shade shade, Material material) {
    if (is_shape(shade.instance)) {
        return material.emission;
    }
    return emission(place_in_mesh(shade.instance, shade.triangle, shade.uv, shade.relative_width), material);
}

// Shades a material of the given kind: one branch where the kind is a constant, as in the callable shaders.
void shade_kind(uint kind, inout Shade shade) {
    Material material = Materials(SCENE.materials).at[shade.material];
    vec3 color = material.base_color.rgb;
    if (kind == MATERIAL_CHECKER) {
        color = checker_color(color, material.checker_color, material.checker_size, shade.object_position);
    }
    shade.albedo = shade_textured(shade, material, color);
    shade.emission = vec3(0.0);
    if (kind != MATERIAL_LIT && shade.seen == 1u) {
        shade.emission = shade_emission(shade, material);
    }
    // Shows its base colour whatever the light; light bounces off it as off any surface (ambray_core::compose).
    if (kind == MATERIAL_UNLIT && shade.seen == 1u) {
        shade.emission += shade.albedo;
        shade.albedo = vec3(0.0);
    }
}

#endif
