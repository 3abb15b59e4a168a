// Where a surface point was when the last frame was rendered: with the instance, triangle and weights that it has now.
#ifndef PREVIOUS_GLSL
#define PREVIOUS_GLSL

#include "surface.glsl"

// World-space position then. A place whose instance has just appeared may have been nowhere: all its points in one.
vec3 previous_position(At at) {
    if (is_shape(at.instance)) {
        mat4x3 m = ShapeInstances(SCENE.previous_shape_instances).at[at.instance - SCENE.mesh_instances].world_from_object;
        return transform_point(m, at.object_position);
    }
    mat4x3 m = Instances(SCENE.previous_instances).at[at.instance].world_from_object;
    Mesh mesh = at.place.mesh;
    bool has_moved = mesh.previous_vertex != NONE && SCENE.previous_positions != 0ul;
    Vec3s table = Vec3s(has_moved ? SCENE.previous_positions : SCENE.positions);
    uint first = has_moved ? mesh.previous_vertex : mesh.first_vertex;
    vec3 points[3];
    for (int i = 0; i < 3; ++i) {
        points[i] = transform_point(m, table.at[first + at.place.corners[i]]);
    }
    return points[0] + (points[1] - points[0]) * at.uv.x + (points[2] - points[0]) * at.uv.y;
}

// Unit normal of the triangle or shape then, on either side; `otherwise` where it has none.
vec3 previous_geometric_normal(At at, vec3 otherwise) {
    if (is_shape(at.instance)) {
        ShapeInstance placed = ShapeInstances(SCENE.previous_shape_instances).at[at.instance - SCENE.mesh_instances];
        vec3 object = shape_normal(Shapes(SCENE.shapes).at[placed.shape], at.object_position);
        return unit_or(placed.normal_from_object * object, otherwise);
    }
    Instance instance = Instances(SCENE.previous_instances).at[at.instance];
    Mesh mesh = at.place.mesh;
    bool has_moved = mesh.previous_vertex != NONE && SCENE.previous_positions != 0ul;
    Vec3s table = Vec3s(has_moved ? SCENE.previous_positions : SCENE.positions);
    uint first = has_moved ? mesh.previous_vertex : mesh.first_vertex;
    vec3 a = transform_point(instance.world_from_object, table.at[first + at.place.corners.x]);
    vec3 e1 = transform_point(instance.world_from_object, table.at[first + at.place.corners.y]) - a;
    vec3 e2 = transform_point(instance.world_from_object, table.at[first + at.place.corners.z]) - a;
    float scale = largest(max(abs(e1), abs(e2)));
    return unit_or(cross(e1 / scale, e2 / scale) * instance.side, otherwise);
}

// Unit normal without normal map then, on either side; `otherwise` where there is none.
vec3 previous_normal(At at, vec3 otherwise) {
    if (is_shape(at.instance) || at.place.mesh.first_normal == NONE) {
        return previous_geometric_normal(at, otherwise);
    }
    Instance instance = Instances(SCENE.previous_instances).at[at.instance];
    Mesh mesh = at.place.mesh;
    bool has_moved = mesh.previous_normal != NONE && SCENE.previous_normals != 0ul;
    uint64_t table = has_moved ? SCENE.previous_normals : SCENE.normals;
    uint first = has_moved ? mesh.previous_normal : mesh.first_normal;
    vec3 object = vertex_vec3(table, first, at.place.corners, at.place.weights);
    return unit_or(instance.normal_from_object * object, otherwise);
}

#endif
