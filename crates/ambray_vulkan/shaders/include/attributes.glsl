// Textures and vertex colours of a surface. Twin of ambray_scene::surface.
#ifndef ATTRIBUTES_GLSL
#define ATTRIBUTES_GLSL

#include "surface.glsl"

vec2 mesh_uv(Place place, TextureUse use, int corner) {
    if (use.uv_set >= place.mesh.uv_sets) {
        return vec2(0.0);
    }
    return Vec2s(SCENE.uvs).at[place.mesh.first_uv + use.uv_set * place.mesh.vertices + place.corners[corner]];
}

vec2 transformed(TextureUse use, vec2 uv) {
    return use.transform[0] * uv.x + use.transform[1] * uv.y + use.transform[2];
}

// Without fused products: where the products cancel, as for texture coordinates on a line, the mip level depends on the
// rounding.
float perp_dot(vec2 a, vec2 b) {
    precise float left = a.x * b.y;
    precise float right = a.y * b.x;
    precise float difference = left - right;
    return difference;
}

vec4 read_texture(Place place, TextureUse use) {
    vec2 a = transformed(use, mesh_uv(place, use, 0));
    vec2 b = transformed(use, mesh_uv(place, use, 1));
    vec2 c = transformed(use, mesh_uv(place, use, 2));
    // Lengths grow from the surface to the texture by the square root of what areas grow by.
    float uv_area = abs(perp_dot(b - a, c - a));
    vec2 uv = a * place.weights.x + b * place.weights.y + c * place.weights.z;
    return sample_texture(use.texture, uv, place.relative_width * sqrt(uv_area));
}

// `color` × texture × vertex colour.
vec3 textured(Place place, Material material, vec3 color) {
    if (material.base_color_texture.texture != NONE) {
        color *= read_texture(place, material.base_color_texture).rgb;
    }
    if (place.mesh.first_color != NONE) {
        color *= vertex_vec4(SCENE.colors, place.mesh.first_color, place.corners, place.weights).rgb;
    }
    return color;
}

vec3 emission(Place place, Material material) {
    if (material.emission_texture.texture == NONE) {
        return material.emission;
    }
    return material.emission * read_texture(place, material.emission_texture).rgb;
}

// Unit tangent and bitangent orthogonal to `smooth_normal`: the directions of the map's red and green. False if there are
// none.
bool tangents(At at, vec3 smooth_normal, TextureUse use, out vec3 tangent, out vec3 bitangent) {
    vec3 along;
    float side;
    Place place = at.place;
    if (place.mesh.first_tangent == NONE) {
        vec2 a = mesh_uv(place, use, 0);
        vec2 d1 = mesh_uv(place, use, 1) - a;
        vec2 d2 = mesh_uv(place, use, 2) - a;
        float det = perp_dot(d1, d2);
        vec3 e1 = at.points[1] - at.points[0];
        vec3 e2 = at.points[2] - at.points[0];
        along = (e1 * d2.y - e2 * d1.y) * sign(det);
        // Upright texture coordinates run clockwise where corners run counter-clockwise, since v points down.
        side = det < 0.0 ? at.side : -at.side;
    } else {
        vec4 object = vertex_vec4(SCENE.tangents, place.mesh.first_tangent, place.corners, place.weights);
        mat4x3 m = Instances(SCENE.instances).at[at.instance].world_from_object;
        along = m[0] * object.x + m[1] * object.y + m[2] * object.z;
        side = object.w < 0.0 ? -at.side : at.side;
    }
    vec3 unit_along = unit_or(along, vec3(0.0));
    tangent = unit_or(unit_along - smooth_normal * dot(unit_along, smooth_normal), vec3(0.0));
    bitangent = cross(smooth_normal, tangent) * side;
    return tangent != vec3(0.0);
}

// `smooth_normal` bent by the normal map (glTF 2.0 §3.9.3 and appendix B.4).
vec3 shading_normal(At at, vec3 smooth_normal) {
    if (is_shape(at.instance)) {
        return smooth_normal;
    }
    Material material = Materials(SCENE.materials).at[at.material];
    vec3 tangent, bitangent;
    if (material.normal_texture.texture == NONE
        || !tangents(at, smooth_normal, material.normal_texture, tangent, bitangent)) {
        return smooth_normal;
    }
    vec3 read = read_texture(at.place, material.normal_texture).rgb * 2.0 - 1.0;
    vec3 bent = read * vec3(material.normal_scale, material.normal_scale, 1.0);
    return unit_or(tangent * bent.x + bitangent * bent.y + smooth_normal * bent.z, smooth_normal);
}

#endif
