// Shading by kind of material: what the callable shaders compute. Ray queries choose by a switch instead.
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

vec3 shade_base_color(Shade shade, Material material) {
    if (is_shape(shade.instance)) {
        return material.base_color.rgb;
    }
    return base_color(place_in_mesh(shade.instance, shade.triangle, shade.uv, shade.relative_width), material);
}

vec3 shade_emission(Shade shade, Material material) {
    if (shade.seen == 0u || is_shape(shade.instance)) {
        return material.emission;
    }
    return emission(place_in_mesh(shade.instance, shade.triangle, shade.uv, shade.relative_width), material);
}

void shade_lit(inout Shade shade) {
    shade.albedo = shade_base_color(shade, Materials(SCENE.materials).at[shade.material]);
    shade.emission = vec3(0.0);
}

void shade_emissive(inout Shade shade) {
    Material material = Materials(SCENE.materials).at[shade.material];
    shade.albedo = shade_base_color(shade, material);
    shade.emission = shade_emission(shade, material);
}

// Shows its base colour whatever the light; light bounces off it as off any surface (ambray_core::compose).
void shade_unlit(inout Shade shade) {
    shade_emissive(shade);
    if (shade.seen == 1u) {
        shade.emission += shade.albedo;
        shade.albedo = vec3(0.0);
    }
}

void shade_checker(inout Shade shade) {
    Material material = Materials(SCENE.materials).at[shade.material];
    vec3 base = shade_base_color(shade, material);
    shade.albedo = checker_color(base, material.checker_color, material.checker_size, shade.object_position);
    shade.emission = shade_emission(shade, material);
}

#endif
