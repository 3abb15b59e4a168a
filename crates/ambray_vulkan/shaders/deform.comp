#version 460
// Bends the vertices of a mesh to a pose, writes them into the tables that the passes read and structures are built from,
// and grows the box around them. The mesh is what the view's address of the push constants leads to.
#extension GL_GOOGLE_include_directive : require
#include "include/extensions.glsl"
#include "include/boxes.glsl"
#include "include/deform.glsl"

layout(local_size_x = MOTION_WIDTH) in;

layout(buffer_reference, scalar, buffer_reference_align = 4) writeonly buffer WrittenVec3s { vec3 at[]; };
layout(buffer_reference, scalar, buffer_reference_align = 16) writeonly buffer WrittenVec4s { vec4 at[]; };

// Boxes of the invocations: one for the workgroup goes to memory, since atomics on one address wait for each other.
shared vec3 lows[MOTION_WIDTH];
shared vec3 highs[MOTION_WIDTH];

void main() {
    Deformation d = DeformationReference(push.view).data;
    uint local = gl_LocalInvocationIndex;
    uint i = gl_GlobalInvocationID.y * push.extent.x + gl_GlobalInvocationID.x;
    bool is_vertex = gl_GlobalInvocationID.x < push.extent.x && i < d.vertices;
    lows[local] = vec3(FAR);
    highs[local] = vec3(-FAR);
    if (is_vertex) {
        Vertex vertex = deform(d, i);
        WrittenVec3s(d.positions).at[i] = vertex.position;
        if (d.normals != 0ul) {
            WrittenVec3s(d.normals).at[i] = vertex.normal;
        }
        if (d.tangents != 0ul) {
            WrittenVec4s(d.tangents).at[i] = vertex.tangent;
        }
        lows[local] = vertex.position;
        highs[local] = vertex.position;
    }
    for (uint stride = MOTION_WIDTH / 2u; stride > 0u; stride /= 2u) {
        barrier();
        if (local < stride) {
            lows[local] = min(lows[local], lows[local + stride]);
            highs[local] = max(highs[local], highs[local + stride]);
        }
    }
    if (local == 0u) {
        grow(d.bounds, lows[0], highs[0]);
    }
}
