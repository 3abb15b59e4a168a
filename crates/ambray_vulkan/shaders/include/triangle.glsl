// Where a ray meets a triangle that the device says it hits: the test of Woop, Benthin and Wald 2013 in the arithmetic of
// the CPU backend (ambray_cpu::kernel), so that the point does not depend on the precision of the device's barycentrics.
#ifndef TRIANGLE_GLSL
#define TRIANGLE_GLSL

// Barycentric weights of the second and third corner; `otherwise` where the triangle is seen edge-on.
vec2 refined_barycentrics(vec3 origin, vec3 direction, vec3 points[3], vec2 otherwise) {
    vec3 size = abs(direction);
    int z = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    int x = (z + 1) % 3;
    int y = (z + 2) % 3;
    float shear_x = direction[x] / direction[z];
    float shear_y = direction[y] / direction[z];
    precise vec2 corners[3];
    for (int i = 0; i < 3; ++i) {
        precise float depth = points[i][z] - origin[z];
        corners[i].x = (points[i][x] - origin[x]) - shear_x * depth;
        corners[i].y = (points[i][y] - origin[y]) - shear_y * depth;
    }
    precise float u = corners[2].x * corners[1].y - corners[2].y * corners[1].x;
    precise float v = corners[0].x * corners[2].y - corners[0].y * corners[2].x;
    precise float w = corners[1].x * corners[0].y - corners[1].y * corners[0].x;
    precise float determinant = u + v + w;
    vec2 refined = vec2(v, w) / determinant;
    // Beyond the triangle the device has found it by a ray that is not quite this one.
    vec3 weights = vec3(1.0 - refined.x - refined.y, refined);
    bool inside = all(greaterThan(weights, vec3(-0.01))) && all(lessThan(weights, vec3(1.01)));
    return inside ? refined : otherwise;
}

#endif
