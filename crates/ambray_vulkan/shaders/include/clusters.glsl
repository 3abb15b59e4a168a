// Clusters of triangles that stand for the inner nodes of a structure: cells of a grid over the mesh as it was built.
#ifndef CLUSTERS_GLSL
#define CLUSTERS_GLSL

#include "boxes.glsl"

layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer ClustersReference { Clusters data; };

// Box of triangle `i`.
void triangle_box(Clusters c, uint i, out vec3 low, out vec3 high) {
    uvec3 corners = Uvec3s(c.triangles).at[i];
    Vec3s positions = Vec3s(c.positions);
    vec3 a = positions.at[corners.x];
    vec3 b = positions.at[corners.y];
    vec3 d = positions.at[corners.z];
    low = min(min(a, b), d);
    high = max(max(a, b), d);
}

// The triangle of this invocation; at least the number of triangles where there is none.
uint triangle_of_invocation(Clusters c) {
    uint i = gl_GlobalInvocationID.y * push.extent.x + gl_GlobalInvocationID.x;
    return gl_GlobalInvocationID.x < push.extent.x ? i : c.triangle_count;
}

#endif
