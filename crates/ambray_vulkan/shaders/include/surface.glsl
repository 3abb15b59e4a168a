// From a hit to the attributes of the surface there. Twin of ambray_scene::surface.
#ifndef SURFACE_GLSL
#define SURFACE_GLSL

#include "scene.glsl"
#include "shape.glsl"
#include "texture.glsl"
#include "triangle.glsl"

// Closest intersection of a ray; `instance` is NONE and `t` FAR on a miss.
struct Hit {
    float t;
    vec2 uv;
    uint instance;
    uint triangle;
};

const Hit MISS = Hit(FAR, vec2(0.0), NONE, 0u);

// Where in a mesh a hit is: what vertex attributes and textures are read by.
struct Place {
    Mesh mesh;
    // Vertices within the mesh.
    uvec3 corners;
    vec3 weights;
    // Footprint in the unit of triangle edges.
    float relative_width;
};

// A hit with what its geometry needs.
struct At {
    uint instance;
    uint material;
    Place place;
    // Barycentric weights of the second and third corner.
    vec2 uv;
    // World space.
    vec3 points[3];
    mat3 normal_from_object;
    float side;
    vec3 position;
    vec3 object_position;
    vec3 geometric_normal;
    float reach;
};

float largest(vec3 v) {
    return max(max(v.x, v.y), v.z);
}

// `v` with unit length, or `otherwise` where it has no direction. Tiny and huge vectors have one.
vec3 unit_or(vec3 v, vec3 otherwise) {
    float size = largest(abs(v));
    if (!(size > 0.0 && size <= FAR)) {
        return otherwise;
    }
    return normalize(v / size);
}

vec3 vertex_vec3(uint64_t table, uint first, uvec3 corners, vec3 weights) {
    Vec3s at = Vec3s(table);
    return at.at[first + corners.x] * weights.x + at.at[first + corners.y] * weights.y
        + at.at[first + corners.z] * weights.z;
}

vec4 vertex_vec4(uint64_t table, uint first, uvec3 corners, vec3 weights) {
    Vec4s at = Vec4s(table);
    return at.at[first + corners.x] * weights.x + at.at[first + corners.y] * weights.y
        + at.at[first + corners.z] * weights.z;
}

// The interpolated vertex normal in world space, or `otherwise`.
vec3 vertex_normal(At at, vec3 otherwise) {
    if (at.place.mesh.first_normal == NONE) {
        return otherwise;
    }
    vec3 object = vertex_vec3(SCENE.normals, at.place.mesh.first_normal, at.place.corners, at.place.weights);
    return unit_or(at.normal_from_object * object, otherwise);
}

vec3 transform_point(mat4x3 m, vec3 p) {
    return m[0] * p.x + m[1] * p.y + m[2] * p.z + m[3];
}

// Bound of the magnitudes that the placed point is computed from.
float magnitude(mat4x3 m, vec3 p) {
    return largest(abs(m[0]) * abs(p.x) + abs(m[1]) * abs(p.y) + abs(m[2]) * abs(p.z) + abs(m[3]));
}

Place place_in_mesh(uint instance, uint triangle, vec2 uv, float relative_width) {
    Mesh mesh = Meshes(SCENE.meshes).at[Instances(SCENE.instances).at[instance].mesh];
    uvec3 corners = Uvec3s(SCENE.triangles).at[mesh.first_triangle + triangle];
    return Place(mesh, corners, vec3(1.0 - uv.x - uv.y, uv), relative_width);
}

At at_triangle(vec3 origin, vec3 direction, Hit hit, float width) {
    Instance instance = Instances(SCENE.instances).at[hit.instance];
    At at;
    at.instance = hit.instance;
    at.place = place_in_mesh(hit.instance, hit.triangle, hit.uv, 0.0);
    at.material = at.place.mesh.material;
    at.normal_from_object = instance.normal_from_object;
    at.side = instance.side;
    at.reach = 0.0;
    vec3 object[3];
    for (int i = 0; i < 3; ++i) {
        object[i] = Vec3s(SCENE.positions).at[at.place.mesh.first_vertex + at.place.corners[i]];
        at.points[i] = transform_point(instance.world_from_object, object[i]);
        at.reach = max(at.reach, magnitude(instance.world_from_object, object[i]));
    }
    at.uv = refined_barycentrics(origin, direction, at.points, hit.uv);
    at.place.weights = vec3(1.0 - at.uv.x - at.uv.y, at.uv);
    vec3 e1 = at.points[1] - at.points[0];
    vec3 e2 = at.points[2] - at.points[0];
    // From the first corner along the edges: exact where edges are short and far from the origin.
    vec2 uv = at.uv;
    at.position = at.points[0] + e1 * uv.x + e2 * uv.y;
    at.object_position = object[0] + (object[1] - object[0]) * uv.x + (object[2] - object[0]) * uv.y;
    // Edges of tiny triangles would vanish when multiplied; scaled to unit size they do not.
    float scale = largest(max(abs(e1), abs(e2)));
    vec3 normal = cross(e1 / scale, e2 / scale);
    float size = length(normal);
    if (size > 0.0) {
        at.geometric_normal = normal * (at.side / size);
        at.place.relative_width = width / (scale * sqrt(size));
    } else {
        // A triangle without area has no normal of its own.
        at.geometric_normal = vertex_normal(at, vec3(0.0, 1.0, 0.0));
    }
    return at;
}

// Of a shape: no vertex attributes, and no texture coordinates.
At at_shape(vec3 origin, vec3 direction, Hit hit) {
    ShapeInstance placed = shape_instance(hit.instance);
    Shape shape = Shapes(SCENE.shapes).at[placed.shape];
    At at;
    at.instance = hit.instance;
    at.material = placed.material;
    at.uv = vec2(0.0);
    at.place.mesh.first_normal = NONE;
    vec3 world = origin + hit.t * direction;
    at.object_position = shape_project(shape, transform_point(placed.object_from_world, world));
    at.position = transform_point(placed.world_from_object, at.object_position);
    at.reach = placed.reach;
    vec3 normal = placed.normal_from_object * shape_normal(shape, at.object_position);
    at.geometric_normal = unit_or(normal, vec3(0.0, 1.0, 0.0));
    return at;
}

// The surface at the hit of a ray, its textures averaged over a footprint of `width` scene units.
At at_hit(vec3 origin, vec3 direction, Hit hit, float width) {
    if (is_shape(hit.instance)) {
        return at_shape(origin, direction, hit);
    }
    return at_triangle(origin, direction, hit, width);
}

// `v` or `-v`, whichever is on the side of `side`.
vec3 towards(vec3 v, vec3 side) {
    return dot(v, side) < 0.0 ? -v : v;
}

#endif
