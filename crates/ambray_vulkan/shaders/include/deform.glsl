// Morph targets and skins. Twin of ambray_scene::animation::Deformer::vertex: the same operations in the same order, none
// of them fused, so that a device which rounds as the standard says puts every vertex where the host would.
#ifndef DEFORM_GLSL
#define DEFORM_GLSL

#include "scene.glsl"

TABLE(Targets, Target, 8);
TABLE(Influences, Influence, 4);
TABLE(Joints, mat4x3, 4);
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer DeformationReference { Deformation data; };

// Bits of ambray_scene::animation::LARGEST_COORDINATE, 1e12.
const uint LARGEST_COORDINATE_BITS = 0x5368d4a5u;
const uint INFINITY_BITS = 0x7f800000u;

struct Vertex {
    vec3 position;
    vec3 normal;
    vec4 tangent;
};

// Whether all coordinates are numbers in range. By bits, since compilers may take it that nothing is not a number.
bool is_within(vec3 p) {
    return all(lessThanEqual(floatBitsToUint(p) & 0x7fffffffu, uvec3(LARGEST_COORDINATE_BITS)));
}

// `v` with length 1, or `rest` where it has no direction.
vec3 deformed_unit(vec3 v, vec3 rest) {
    precise float square = v.x * v.x + v.y * v.y + v.z * v.z;
    precise float size = sqrt(square);
    precise float inverse = 1.0 / size;
    precise vec3 scaled = v * inverse;
    uint bits = floatBitsToUint(inverse);
    return bits > 0u && bits < INFINITY_BITS ? scaled : rest;
}

vec3 deformed_cross(vec3 a, vec3 b) {
    precise vec3 left = vec3(a.y * b.z, a.z * b.x, a.x * b.y);
    precise vec3 right = vec3(a.z * b.y, a.x * b.z, a.y * b.x);
    precise vec3 product = left - right;
    return product;
}

float deformed_determinant(mat3 m) {
    vec3 c = deformed_cross(m[1], m[2]);
    precise float determinant = m[0].x * c.x + m[0].y * c.y + m[0].z * c.z;
    return determinant;
}

vec3 deformed_vector(mat3 m, vec3 v) {
    precise vec3 moved = m[0] * v.x + m[1] * v.y + m[2] * v.z;
    return moved;
}

// Twin of ambray_scene::surface::normal_matrix.
mat3 deformed_normal_matrix(mat3 m) {
    vec3 most = max(max(abs(m[0]), abs(m[1])), abs(m[2]));
    float size = max(max(most.x, most.y), most.z);
    if (size > 0.0) {
        precise float inverse = 1.0 / size;
        precise mat3 scaled = mat3(m[0] * inverse, m[1] * inverse, m[2] * inverse);
        m = scaled;
    }
    float side = deformed_determinant(m) < 0.0 ? -1.0 : 1.0;
    return mat3(
        deformed_cross(m[1], m[2]) * side, deformed_cross(m[2], m[0]) * side, deformed_cross(m[0], m[1]) * side);
}

// Weighted mean of the joints of vertex `i`; weights that do not add up to 1 are scaled, and without any the first joint
// rules.
mat4x3 deformed_blend(Deformation d, uint i) {
    Influences influences = Influences(d.influences);
    Joints joints = Joints(d.joints);
    uint first = i * d.influences_per_vertex;
    precise float total = 0.0;
    for (uint k = 0u; k < d.influences_per_vertex; ++k) {
        total = total + influences.at[first + k].weight;
    }
    uint bits = floatBitsToUint(total);
    if (!(bits > 0u && bits < INFINITY_BITS)) {
        return joints.at[influences.at[first].joint];
    }
    precise mat4x3 sum = mat4x3(0.0);
    for (uint k = 0u; k < d.influences_per_vertex; ++k) {
        Influence influence = influences.at[first + k];
        if (influence.weight != 0.0) {
            mat4x3 joint = joints.at[influence.joint];
            precise float weight = influence.weight / total;
            for (int column = 0; column < 4; ++column) {
                precise vec3 part = joint[column] * weight;
                sum[column] = sum[column] + part;
            }
        }
    }
    return sum;
}

// `v` and the displacement of vertex `i` in `table` by `weight`.
vec3 displaced(vec3 v, uint64_t table, uint i, float weight) {
    vec3 delta = table == 0ul ? vec3(0.0) : Vec3s(table).at[i];
    precise vec3 part = delta * weight;
    precise vec3 sum = v + part;
    return sum;
}

Vertex deform(Deformation d, uint i) {
    vec3 rest_normal = d.rest_normals == 0ul ? vec3(0.0) : Vec3s(d.rest_normals).at[i];
    vec4 rest_tangent = d.rest_tangents == 0ul ? vec4(0.0) : Vec4s(d.rest_tangents).at[i];
    vec3 position = Vec3s(d.rest_positions).at[i];
    vec3 normal = rest_normal;
    vec3 tangent = rest_tangent.xyz;
    float side = rest_tangent.w;
    for (uint k = 0u; k < d.target_count; ++k) {
        Target target = Targets(d.targets).at[k];
        position = displaced(position, target.positions, i, target.weight);
        normal = displaced(normal, target.normals, i, target.weight);
        tangent = displaced(tangent, target.tangents, i, target.weight);
    }
    if (d.influences_per_vertex > 0u) {
        mat4x3 m = deformed_blend(d, i);
        mat3 linear = mat3(m[0], m[1], m[2]);
        precise vec3 moved = deformed_vector(linear, position) + m[3];
        position = moved;
        normal = deformed_vector(deformed_normal_matrix(linear), normal);
        // A mirroring bone mirrors the bitangent, too.
        side = deformed_determinant(linear) < 0.0 ? -side : side;
        tangent = deformed_vector(linear, tangent);
    }
    Vertex vertex;
    vertex.position = is_within(position) ? position : vec3(0.0);
    // Without an attribute at rest there is none.
    vertex.normal = d.rest_normals == 0ul ? vec3(0.0) : deformed_unit(normal, rest_normal);
    vec3 along = d.rest_tangents == 0ul ? vec3(0.0) : deformed_unit(tangent, rest_tangent.xyz);
    vertex.tangent = vec4(along, side);
    return vertex;
}

#endif
