#version 460
// Grows the boxes of the clusters of a mesh by its triangles, and counts them.
#extension GL_GOOGLE_include_directive : require
#include "include/extensions.glsl"
#include "include/clusters.glsl"

layout(local_size_x = MOTION_WIDTH) in;

void main() {
    Clusters c = ClustersReference(push.view).data;
    uint i = triangle_of_invocation(c);
    if (i >= c.triangle_count) {
        return;
    }
    vec3 low, high;
    triangle_box(c, i, low, high);
    uint64_t box = c.boxes + uint64_t(Words(c.clusters).at[i]) * uint64_t(4u * CLUSTER_WORDS);
    grow(box, low, high);
    atomicAdd(Words(box).at[BOX_WORDS], 1u);
}
