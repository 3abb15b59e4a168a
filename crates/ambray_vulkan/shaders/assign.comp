#version 460
// Puts each triangle of a mesh into the cluster in whose cell of the grid its box is centred. Runs when a structure is built.
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
    vec3 from = low_corner(c.bounds);
    vec3 size = high_corner(c.bounds) - from;
    vec3 share = ((0.5 * low + 0.5 * high) - from) / max(size, vec3(1e-30));
    uvec3 cell = uvec3(clamp(floor(share * float(c.side)), vec3(0.0), vec3(float(c.side - 1u))));
    Words(c.clusters).at[i] = (cell.z * c.side + cell.y) * c.side + cell.x;
}
