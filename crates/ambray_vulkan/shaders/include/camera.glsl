// From pixels to primary rays, and the size of a pixel in the scene (spec §7). Twin of ambray_core::camera.
#ifndef CAMERA_GLSL
#define CAMERA_GLSL

#include "scene.glsl"

Ray primary_ray(uvec2 pixel, uint seed) {
    vec2 size = vec2(VIEW.size);
    // Place in the picture plane: x to the right, y up, scaled so that the picture reaches up to half_height.
    float scale = VIEW.half_height / (0.5 * size.y);
    float right = (float(pixel.x) + 0.5 - 0.5 * size.x) * scale;
    float up = (0.5 * size.y - float(pixel.y) - 0.5) * scale;
    vec3 offset = VIEW.right * right + VIEW.up * up;
    if (VIEW.orthographic != 0u) {
        return Ray(VIEW.eye + offset, FAR, VIEW.forward, seed);
    }
    return Ray(VIEW.eye, FAR, normalize(VIEW.forward + offset), seed);
}

// View depth: distance from the camera plane.
float view_depth(vec3 point) {
    return dot(point - VIEW.eye, VIEW.forward);
}

// Size of a pixel at view depth `depth`, scene units.
float pixel_footprint(float depth) {
    float pixel = VIEW.half_height / (0.5 * float(VIEW.size.y));
    return VIEW.orthographic != 0u ? pixel : depth * pixel;
}

#endif
