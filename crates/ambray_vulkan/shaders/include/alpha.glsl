// Whether a ray sees a surface that is not opaque. Twin of ambray_scene::surface::Surfaces::accepts.
#ifndef ALPHA_GLSL
#define ALPHA_GLSL

#include "attributes.glsl"
#include "sampling.glsl"

bool alpha_accepts(Material material, float alpha, uint instance, uint triangle, uint seed) {
    switch (material.alpha_mode) {
        case ALPHA_OPAQUE: return true;
        case ALPHA_MASK: return alpha >= material.alpha_cutoff;
        default: return alpha > alpha_threshold(seed, instance, triangle);
    }
}

bool accepts_triangle(uint instance, uint triangle, vec2 uv, uint seed) {
    Place place = place_in_mesh(instance, triangle, uv, 0.0);
    Material material = Materials(SCENE.materials).at[place.mesh.material];
    float alpha = material.base_color.a;
    TextureUse use = material.base_color_texture;
    if (use.texture != NONE) {
        vec2 at = mesh_uv(place, use, 0) * place.weights.x + mesh_uv(place, use, 1) * place.weights.y
            + mesh_uv(place, use, 2) * place.weights.z;
        alpha *= texture_alpha(use.texture, transformed(use, at));
    }
    if (place.mesh.first_color != NONE) {
        alpha *= vertex_vec4(SCENE.colors, place.mesh.first_color, place.corners, place.weights).a;
    }
    return alpha_accepts(material, alpha, instance, triangle, seed);
}

bool accepts_shape(uint instance, uint seed) {
    Material material = Materials(SCENE.materials).at[shape_instance(instance).material];
    return alpha_accepts(material, material.base_color.a, instance, 0u, seed);
}

#endif
