// Orthonormal basis of a normal (Duff et al. 2017; spec §1). Twin of ambray_core::basis.
#ifndef BASIS_GLSL
#define BASIS_GLSL

// Columns (t, b, n).
mat3 basis_from_normal(vec3 n) {
    float s = n.z >= 0.0 ? 1.0 : -1.0;
    float p = -1.0 / (s + n.z);
    float q = n.x * n.y * p;
    return mat3(vec3(1.0 + s * n.x * n.x * p, s * q, -s * n.x), vec3(q, s + n.y * n.y * p, -n.y), n);
}

#endif
