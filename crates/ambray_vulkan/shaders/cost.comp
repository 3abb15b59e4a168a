#version 460
// Surface-area cost of the clusters of a mesh as leaves: surface of their boxes times their triangles, over the surface of the
// box around all. One workgroup adds in a fixed order, so that the same pose always costs the same.
#extension GL_GOOGLE_include_directive : require
#include "include/extensions.glsl"
#include "include/clusters.glsl"

layout(local_size_x = MOTION_WIDTH) in;

shared float sums[MOTION_WIDTH];

float half_area(vec3 size) {
    return size.x * size.y + size.y * size.z + size.z * size.x;
}

void main() {
    Clusters c = ClustersReference(push.view).data;
    uint local = gl_LocalInvocationIndex;
    uint count = c.side * c.side * c.side;
    // In units of the mesh, so that products of huge or tiny lengths stay numbers.
    vec3 size = high_corner(c.bounds) - low_corner(c.bounds);
    float unit = max(max(size.x, size.y), max(size.z, 1e-30));
    float sum = 0.0;
    for (uint i = local; i < count; i += MOTION_WIDTH) {
        uint64_t box = c.boxes + uint64_t(i) * uint64_t(4u * CLUSTER_WORDS);
        // Counts begin one below 0, where the boxes begin.
        uint triangles = Words(box).at[BOX_WORDS] + 1u;
        if (triangles > 0u) {
            sum += float(triangles) * half_area((high_corner(box) - low_corner(box)) / unit);
        }
    }
    sums[local] = sum;
    for (uint stride = MOTION_WIDTH / 2u; stride > 0u; stride /= 2u) {
        barrier();
        if (local < stride) {
            sums[local] += sums[local + stride];
        }
    }
    if (local == 0u) {
        float all = half_area(size / unit);
        Words(c.cost).at[0] = floatBitsToUint(all > 0.0 ? sums[0] / all : 0.0);
    }
}
