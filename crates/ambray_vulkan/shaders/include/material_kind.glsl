// The checker of a material. Twin of ambray_scene::material::Checker.
#ifndef MATERIAL_KIND_GLSL
#define MATERIAL_KIND_GLSL

// Share of a cube by which the pattern is moved: faces between two layers of cubes show one of them.
const float CHECKER_BIAS = 1.0 / 1024.0;

vec3 checker_color(vec3 base, vec3 second, float size, vec3 object_position) {
    precise vec3 cube = floor(object_position / size + CHECKER_BIAS);
    precise float sum = cube.x + cube.y + cube.z;
    // Even sums are twice an integer.
    return sum - 2.0 * floor(0.5 * sum) == 0.0 ? base : second;
}

#endif
