bool shape_intersect(Shape shape, vec3 origin, vec3 direction, float t_max, out float t) { t = 1.0; return false; }
vec3 shape_normal(Shape s, vec3 p) { return p; }
vec3 shape_project(Shape s, vec3 p) { return p; }
