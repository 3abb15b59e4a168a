// Rays against placed shapes.
#ifndef SHAPE_RAY_GLSL
#define SHAPE_RAY_GLSL

#include "surface.glsl"

// Distance at which a ray meets shape instance `instance`, in (0, t_max).
bool hit_shape(uint instance, vec3 origin, vec3 direction, float t_max, out float t) {
    ShapeInstance placed = shape_instance(instance);
    mat4x3 m = placed.object_from_world;
    vec3 object_direction = m[0] * direction.x + m[1] * direction.y + m[2] * direction.z;
    return shape_intersect(
        Shapes(SCENE.shapes).at[placed.shape], transform_point(m, origin), object_direction, t_max, t);
}

#endif
