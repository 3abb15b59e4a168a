// Which pixels see the same surface. Twin of ambray_core::filter::Filter::accepts.
#ifndef ACCEPTANCE_GLSL
#define ACCEPTANCE_GLSL

#include "scene.glsl"

// Acceptance A(p, q) of a pixel that sees `other` by one that sees `p`, both with their depths in w: close to its tangent
// plane or depth, and facing alike.
bool accepts(vec4 p, vec3 normal, float footprint, vec4 other, vec3 other_normal) {
    bool near;
    switch (TEST) {
        case TEST_PLANE: near = abs(dot(normal, other.xyz - p.xyz)) < VIEW.filter_by.tolerance * footprint; break;
        case TEST_ABSOLUTE: near = abs(other.w - p.w) < VIEW.filter_by.tolerance; break;
        case TEST_RELATIVE: near = abs(other.w - p.w) < VIEW.filter_by.tolerance * p.w; break;
        default: near = true; break;
    }
    float least = VIEW.filter_by.cos_normal;
    return near && (least <= -1.0 || dot(normal, other_normal) > least);
}

#endif
