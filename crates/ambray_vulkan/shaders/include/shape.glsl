// Shapes given by formulas: where rays meet them, normals, and points moved onto them. Twin of ambray_core::shape, where the
// formulas are explained; operations are in its order, and nothing that cancels may be contracted.
#ifndef SHAPE_GLSL
#define SHAPE_GLSL

#include "scene.glsl"

// Stands for infinity, which shaders need not have.
const float SHAPE_FAR = 3.402823466e38;
const float SHAPE_EPSILON = 1.0 / 8388608.0;

// Parts of a line are (near, far), empty if near > far.
const vec2 SHAPE_ALL = vec2(-SHAPE_FAR, SHAPE_FAR);
const vec2 SHAPE_EMPTY = vec2(SHAPE_FAR, -SHAPE_FAR);

vec2 shape_between(float a, float b) {
    return vec2(min(a, b), max(a, b));
}

vec2 shape_both(vec2 a, vec2 b) {
    return vec2(max(a.x, b.x), min(a.y, b.y));
}

vec2 shape_hull(vec2 a, vec2 b) {
    return vec2(min(a.x, b.x), max(a.y, b.y));
}

// Built-in products of vectors may be contracted.
float shape_dot(vec3 a, vec3 b) {
    precise float sum = a.x * b.x + a.y * b.y + a.z * b.z;
    return sum;
}

float shape_dot(vec2 a, vec2 b) {
    precise float sum = a.x * b.x + a.y * b.y;
    return sum;
}

// Distance from the y axis.
float shape_rho(vec3 p) {
    precise float square = p.x * p.x + p.z * p.z;
    return sqrt(square);
}

float shape_sign(float x) {
    return x < 0.0 ? -1.0 : 1.0;
}

// Spheres.

vec2 shape_sphere_crossing(vec3 o, vec3 d, float radius) {
    precise float a = shape_dot(d, d);
    precise float b = shape_dot(o, d);
    precise vec3 closest = o - d * (b / a);
    precise float closest_length = sqrt(shape_dot(closest, closest));
    precise float inner = (radius - closest_length) * (radius + closest_length);
    if (inner < 0.0) {
        return SHAPE_EMPTY;
    }
    precise float from_centre = sqrt(shape_dot(o, o));
    precise float c = (from_centre - radius) * (from_centre + radius);
    precise float root = sqrt(a * inner);
    precise float q = b < 0.0 ? root - b : -b - root;
    if (q == 0.0) {
        return SHAPE_EMPTY;
    }
    return shape_between(c / q, q / a);
}

vec3 shape_sphere_normal(vec3 p) {
    precise float size = sqrt(shape_dot(p, p));
    return size > 0.0 ? p / size : vec3(0.0, 1.0, 0.0);
}

// Boxes.

vec2 shape_slab(float o, float d, float size) {
    if (d == 0.0) {
        return abs(o) <= size ? SHAPE_ALL : SHAPE_EMPTY;
    }
    precise float low = (-size - o) / d;
    precise float high = (size - o) / d;
    return shape_between(low, high);
}

vec2 shape_box_crossing(vec3 o, vec3 d, vec3 size) {
    vec2 x = shape_slab(o.x, d.x, size.x);
    vec2 y = shape_slab(o.y, d.y, size.y);
    vec2 z = shape_slab(o.z, d.z, size.z);
    return shape_both(shape_both(x, y), z);
}

// The axis of the face next to p; of several the first.
int shape_box_axis(vec3 p, vec3 size) {
    precise vec3 outside = abs(p) - size;
    if (outside.x >= outside.y && outside.x >= outside.z) {
        return 0;
    }
    return outside.y >= outside.z ? 1 : 2;
}

// Cones around the y axis: cos rho + sin y - offset is the signed distance.

struct ShapeCone {
    float cosine;
    float sine;
    float offset;
};

struct ShapeRoots {
    float a;
    float b;
    float c;
    float growth;
    bool real;
    float t0;
    // SHAPE_FAR where a is 0.
    float t1;
};

ShapeRoots shape_cone_roots(ShapeCone cone, vec3 o, vec3 d) {
    vec2 e = o.xz;
    vec2 f = d.xz;
    precise float radius = cone.offset - cone.sine * o.y;
    precise float growth = -(cone.sine * d.y);
    precise float rho = cone.cosine * sqrt(shape_dot(e, e));
    precise float c = (rho - radius) * (rho + radius);
    precise float b = cone.cosine * cone.cosine * shape_dot(e, f) - radius * growth;
    precise float speed = cone.cosine * sqrt(shape_dot(f, f));
    precise float a = (speed - growth) * (speed + growth);
    precise vec2 along = f * radius - e * growth;
    precise float v = sqrt(shape_dot(along, along));
    precise float across = e.x * f.y - e.y * f.x;
    precise float x = cone.cosine * abs(across);
    precise float discriminant = (v - x) * (v + x);
    ShapeRoots roots = ShapeRoots(a, b, c, growth, false, 0.0, SHAPE_FAR);
    if (discriminant < 0.0 && a > 0.0) {
        return roots;
    }
    precise float root = cone.cosine * sqrt(max(discriminant, 0.0));
    precise float q = b < 0.0 ? root - b : -b - root;
    if (q != 0.0) {
        roots.real = true;
        roots.t0 = c / q;
        roots.t1 = a == 0.0 ? SHAPE_FAR : q / a;
    }
    return roots;
}

vec3 shape_cone_normal(ShapeCone cone, vec3 p) {
    float rho = shape_rho(p);
    if (rho == 0.0) {
        return vec3(0.0, shape_sign(cone.sine), 0.0);
    }
    precise float radial = cone.cosine / rho;
    precise vec3 normal = vec3(p.x * radial, cone.sine, p.z * radial);
    return normal;
}

float shape_cone_distance(ShapeCone cone, float rho, float y) {
    precise float distance_to_cone = cone.cosine * rho + cone.sine * y - cone.offset;
    return distance_to_cone;
}

// Where the line is within the nappe, for lines that do not reach the other one.
vec2 shape_cone_inside(ShapeRoots roots) {
    if (!roots.real) {
        return roots.a <= 0.0 && roots.c <= 0.0 ? SHAPE_ALL : SHAPE_EMPTY;
    }
    vec2 both = shape_between(roots.t0, roots.t1);
    if (roots.a > 0.0) {
        return both;
    }
    if (roots.a == 0.0) {
        return roots.b > 0.0 ? vec2(-SHAPE_FAR, roots.t0) : vec2(roots.t0, SHAPE_FAR);
    }
    return roots.growth > 0.0 ? vec2(both.y, SHAPE_FAR) : vec2(-SHAPE_FAR, both.x);
}

// Cylinders: a height, b and c the lower and the upper radius.

ShapeCone shape_cylinder_side(Shape shape) {
    precise float taper = shape.b - shape.c;
    precise float slant = sqrt(shape.a * shape.a + taper * taper);
    precise float cosine = shape.a / slant;
    precise float offset = cosine * (0.5 * (shape.b + shape.c));
    return ShapeCone(cosine, taper / slant, offset);
}

vec2 shape_cylinder_crossing(Shape shape, vec3 o, vec3 d) {
    vec2 between = shape_slab(o.y, d.y, 0.5 * shape.a);
    return shape_both(between, shape_cone_inside(shape_cone_roots(shape_cylinder_side(shape), o, d)));
}

// The face next to p: -1 and 1 for the discs, 0 for the side.
float shape_cylinder_face(Shape shape, ShapeCone side, vec3 p) {
    precise float beyond = abs(p.y) - 0.5 * shape.a;
    return beyond < shape_cone_distance(side, shape_rho(p), p.y) ? 0.0 : shape_sign(p.y);
}

// Capsules: a height, b and c the lower and the upper radius.

// Whether the spheres have a side between them; not if one holds the other.
bool shape_capsule_side(Shape shape, out ShapeCone side) {
    precise float taper = shape.b - shape.c;
    precise float sine = taper / shape.a;
    precise float square = (1.0 - sine) * (1.0 + sine);
    side = ShapeCone(0.0, 0.0, 0.0);
    if (shape.a <= abs(taper)) {
        return false;
    }
    side = ShapeCone(sqrt(square), sine, 0.5 * (shape.b + shape.c));
    return true;
}

vec2 shape_capsule_crossing(Shape shape, vec3 o, vec3 d) {
    vec3 middle = vec3(0.0, 0.5 * shape.a, 0.0);
    vec2 hull = SHAPE_EMPTY;
    if (shape.b > 0.0) {
        precise vec3 from = o + middle;
        hull = shape_hull(hull, shape_sphere_crossing(from, d, shape.b));
    }
    if (shape.c > 0.0) {
        precise vec3 from = o - middle;
        hull = shape_hull(hull, shape_sphere_crossing(from, d, shape.c));
    }
    ShapeCone side;
    if (!shape_capsule_side(shape, side)) {
        return hull;
    }
    precise float low = side.sine * shape.b - middle.y;
    precise float high = side.sine * shape.c + middle.y;
    ShapeRoots roots = shape_cone_roots(side, o, d);
    if (roots.real) {
        precise float y0 = o.y + roots.t0 * d.y;
        if (y0 >= low && y0 <= high) {
            hull = shape_hull(hull, vec2(roots.t0));
        }
        precise float y1 = o.y + roots.t1 * d.y;
        if (y1 >= low && y1 <= high && roots.t1 < SHAPE_FAR) {
            hull = shape_hull(hull, vec2(roots.t1));
        }
    }
    return hull;
}

// The part next to p: the cone (true), or the sphere with this height of the centre and this radius.
bool shape_capsule_part(Shape shape, vec3 p, out ShapeCone side, out vec2 sphere) {
    float middle = 0.5 * shape.a;
    if (!shape_capsule_side(shape, side)) {
        sphere = shape.b >= shape.c ? vec2(-middle, shape.b) : vec2(middle, shape.c);
        return false;
    }
    precise float along = side.cosine * (p.y + middle) - side.sine * shape_rho(p);
    sphere = along < 0.0 ? vec2(-middle, shape.b) : vec2(middle, shape.c);
    return along >= 0.0 && along <= side.cosine * shape.a;
}

// Fields.

struct ShapeCell {
    // Coefficients of 1, x, y, z, xy, yz, zx, xyz.
    float k[8];
    float largest;
};

vec3 shape_field_cells(Shape shape) {
    return vec3(shape.grid - 1u);
}

vec3 shape_field_density(Shape shape) {
    return shape_field_cells(shape) / (shape.box_max + shape.box_max);
}

vec3 shape_field_corner(Shape shape, vec3 g) {
    return min(max(floor(g), vec3(0.0)), shape_field_cells(shape) - 1.0);
}

ShapeCell shape_field_cell(Shape shape, vec3 corner) {
    FloatArray samples = FloatArray(shape.field);
    uint nx = shape.grid.x;
    uint ny = shape.grid.y;
    uint first = (uint(corner.z) * ny + uint(corner.y)) * nx + uint(corner.x);
    float s000 = samples.at[first];
    float s100 = samples.at[first + 1u];
    float s010 = samples.at[first + nx];
    float s110 = samples.at[first + nx + 1u];
    uint next = first + nx * ny;
    float s001 = samples.at[next];
    float s101 = samples.at[next + 1u];
    float s011 = samples.at[next + nx];
    float s111 = samples.at[next + nx + 1u];
    precise float x = s100 - s000;
    precise float y = s010 - s000;
    precise float z = s001 - s000;
    precise float xy = (s110 - s010) - x;
    precise float yz = (s011 - s001) - y;
    precise float zx = (s101 - s100) - z;
    precise float xyz = ((s111 - s011) - (s101 - s001)) - xy;
    float low = max(max(max(abs(s000), abs(s100)), abs(s010)), abs(s110));
    float high = max(max(max(abs(s001), abs(s101)), abs(s011)), abs(s111));
    return ShapeCell(float[8](s000, x, y, z, xy, yz, zx, xyz), max(low, high));
}

float shape_cell_value(ShapeCell cell, vec3 p, out vec3 slope) {
    precise float x = cell.k[1] + cell.k[4] * p.y + (cell.k[6] + cell.k[7] * p.y) * p.z;
    precise float y = cell.k[2] + cell.k[4] * p.x + (cell.k[5] + cell.k[7] * p.x) * p.z;
    precise float z = cell.k[3] + cell.k[6] * p.x + (cell.k[5] + cell.k[7] * p.x) * p.y;
    slope = vec3(x, y, z);
    precise float value = cell.k[0] + cell.k[1] * p.x + (cell.k[2] + cell.k[4] * p.x) * p.y + z * p.z;
    return value;
}

// The cubic along the segment from p by v, for parameters in [0, 1].
vec4 shape_cell_along(ShapeCell cell, vec3 p, vec3 v) {
    vec3 slope;
    float value = shape_cell_value(cell, p, slope);
    precise float bends = (cell.k[4] + cell.k[7] * p.z) * (v.x * v.y)
        + (cell.k[5] + cell.k[7] * p.x) * (v.y * v.z)
        + (cell.k[6] + cell.k[7] * p.y) * (v.z * v.x);
    precise float twist = cell.k[7] * (v.x * v.y) * v.z;
    return vec4(value, shape_dot(slope, v), bends, twist);
}

float shape_cubic(vec4 c, float s) {
    precise float value = c.x + s * (c.y + s * (c.z + s * c.w));
    return value;
}

// The sign change between low, on the side `inside`, and high: Newton's method, kept within the bracket.
float shape_cubic_bisect(vec4 c, float low, float high, bool inside) {
    precise float s = 0.5 * (low + high);
    for (int i = 0; i < 24; i++) {
        float value = shape_cubic(c, s);
        if ((value < 0.0) == inside) {
            low = s;
        } else {
            high = s;
        }
        precise float slope = c.y + s * (2.0 * c.z + s * (3.0 * c.w));
        precise float newton = slope == 0.0 ? low : s - value / slope;
        precise float middle = 0.5 * (low + high);
        float next = newton > low && newton < high ? newton : middle;
        if (next == s) {
            break;
        }
        s = next;
    }
    return s;
}

// Where the sign first differs from `inside`.
bool shape_cubic_crossing(vec4 c, bool inside, out float share) {
    share = 0.0;
    if ((c.x < 0.0) != inside) {
        return true;
    }
    precise float a = 3.0 * c.w;
    precise float discriminant = c.z * c.z - a * c.y;
    float highs[3] = float[3](1.0, 1.0, 1.0);
    if (discriminant > 0.0) {
        precise float root = sqrt(discriminant);
        precise float q = c.z < 0.0 ? root - c.z : -c.z - root;
        float first = q == 0.0 ? 1.0 : c.y / q;
        float second = a == 0.0 ? 1.0 : q / a;
        highs[0] = min(max(min(first, second), 0.0), 1.0);
        highs[1] = min(max(max(first, second), 0.0), 1.0);
    }
    float low = 0.0;
    for (int i = 0; i < 3; i++) {
        if ((shape_cubic(c, highs[i]) < 0.0) != inside) {
            share = shape_cubic_bisect(c, low, highs[i], inside);
            return true;
        }
        low = highs[i];
    }
    return false;
}

// When a ray from g leaves the cell at `corner` along an axis.
float shape_field_plane(float corner, float toward, float g, float v) {
    precise float along = corner + 0.5 * (toward + 1.0) - g;
    return v == 0.0 ? SHAPE_FAR : along / v;
}

bool shape_field_intersect(Shape shape, vec3 o, vec3 d, float t_max, out float t) {
    t = 0.0;
    vec3 size = shape.box_max;
    vec2 span = shape_both(shape_box_crossing(o, d, size), vec2(0.0, t_max));
    if (span.x > span.y) {
        return false;
    }
    precise float start = span.x;
    precise float last = span.y - span.x;
    precise vec3 entry = o;
    if (start > 0.0) {
        entry = min(max(o + d * start, -size), size);
    }
    vec3 density = shape_field_density(shape);
    precise vec3 g = (entry + size) * density;
    precise vec3 v = d * density;
    vec3 corner = shape_field_corner(shape, g);
    vec3 top = shape_field_cells(shape) - 1.0;
    vec3 toward = vec3(shape_sign(v.x), shape_sign(v.y), shape_sign(v.z));
    float now = 0.0;
    bool inside = false;
    uint most = shape.grid.x + shape.grid.y + shape.grid.z;
    for (uint i = 0u; i < most; i++) {
        vec3 leave = vec3(shape_field_plane(corner.x, toward.x, g.x, v.x),
                          shape_field_plane(corner.y, toward.y, g.y, v.y),
                          shape_field_plane(corner.z, toward.z, g.z, v.z));
        float next = min(min(leave.x, leave.y), leave.z);
        float end = max(min(next, last), now);
        precise vec3 from = g + v * now - corner;
        precise vec3 to = g + v * end - corner;
        from = min(max(from, vec3(0.0)), vec3(1.0));
        to = min(max(to, vec3(0.0)), vec3(1.0));
        precise vec3 way = to - from;
        ShapeCell cell = shape_field_cell(shape, corner);
        vec4 cubic = shape_cell_along(cell, from, way);
        if (i == 0u) {
            precise float noise = 4.0 * SHAPE_EPSILON * cell.largest * (2.0 + max(max(top.x, top.y), top.z));
            inside = abs(cubic.x) <= noise ? cubic.y < 0.0 : cubic.x < 0.0;
        }
        float share;
        if (shape_cubic_crossing(cubic, inside, share)) {
            precise float at = start + (now + (end - now) * share);
            if (at > 0.0 && at <= t_max) {
                t = at;
                return true;
            }
        }
        inside = shape_cubic(cubic, 1.0) < 0.0;
        if (next >= last) {
            return false;
        }
        if (leave.x <= leave.y && leave.x <= leave.z) {
            corner.x += toward.x;
        } else if (leave.y <= leave.z) {
            corner.y += toward.y;
        } else {
            corner.z += toward.z;
        }
        if (any(lessThan(corner, vec3(0.0))) || any(greaterThan(corner, top))) {
            return false;
        }
        now = end;
    }
    return false;
}

// Value and gradient at p, or at the point of the box next to it.
float shape_field_value(Shape shape, vec3 p, out vec3 gradient) {
    vec3 density = shape_field_density(shape);
    precise vec3 g = (p + shape.box_max) * density;
    vec3 corner = shape_field_corner(shape, g);
    precise vec3 within = min(max(g - corner, vec3(0.0)), vec3(1.0));
    float value = shape_cell_value(shape_field_cell(shape, corner), within, gradient);
    gradient *= density;
    return value;
}

// All shapes.

// Whether origin + t direction meets the surface, from either side, at some t in (0, t_max]; the smallest such t.
bool shape_intersect(Shape shape, vec3 origin, vec3 direction, float t_max, out float t) {
    t = 0.0;
    vec2 within;
    switch (shape.kind) {
        case SHAPE_SPHERE: within = shape_sphere_crossing(origin, direction, shape.a); break;
        case SHAPE_BOX: within = shape_box_crossing(origin, direction, vec3(shape.a, shape.b, shape.c)); break;
        case SHAPE_CAPSULE: within = shape_capsule_crossing(shape, origin, direction); break;
        case SHAPE_CYLINDER: within = shape_cylinder_crossing(shape, origin, direction); break;
        default: return shape_field_intersect(shape, origin, direction, t_max, t);
    }
    if (within.x > within.y) {
        return false;
    }
    t = within.x > 0.0 ? within.x : within.y;
    return t > 0.0 && t <= t_max && t < SHAPE_FAR;
}

// Unit normal on the outer side at the point p of the surface.
vec3 shape_normal(Shape shape, vec3 p) {
    switch (shape.kind) {
        case SHAPE_SPHERE: return shape_sphere_normal(p);
        case SHAPE_BOX: {
            vec3 normal = vec3(0.0);
            int axis = shape_box_axis(p, vec3(shape.a, shape.b, shape.c));
            normal[axis] = shape_sign(p[axis]);
            return normal;
        }
        case SHAPE_CAPSULE: {
            ShapeCone side;
            vec2 sphere;
            if (shape_capsule_part(shape, p, side, sphere)) {
                return shape_cone_normal(side, p);
            }
            return shape_sphere_normal(p - vec3(0.0, sphere.x, 0.0));
        }
        case SHAPE_CYLINDER: {
            ShapeCone side = shape_cylinder_side(shape);
            float face = shape_cylinder_face(shape, side, p);
            return face == 0.0 ? shape_cone_normal(side, p) : vec3(0.0, face, 0.0);
        }
        default: {
            vec3 gradient;
            shape_field_value(shape, p, gradient);
            float largest = max(max(abs(gradient.x), abs(gradient.y)), abs(gradient.z));
            if (largest > 0.0) {
                vec3 scaled = gradient / largest;
                return scaled / sqrt(shape_dot(scaled, scaled));
            }
            return vec3(0.0, 1.0, 0.0);
        }
    }
}

// The point of the surface next to p, which is off it by rounding only.
vec3 shape_project(Shape shape, vec3 p) {
    switch (shape.kind) {
        case SHAPE_SPHERE: return shape_sphere_normal(p) * shape.a;
        case SHAPE_BOX: {
            vec3 size = vec3(shape.a, shape.b, shape.c);
            vec3 q = min(max(p, -size), size);
            int axis = shape_box_axis(p, size);
            q[axis] = shape_sign(p[axis]) * size[axis];
            return q;
        }
        case SHAPE_CAPSULE: {
            ShapeCone side;
            vec2 sphere;
            if (shape_capsule_part(shape, p, side, sphere)) {
                precise vec3 q = p - shape_cone_normal(side, p) * shape_cone_distance(side, shape_rho(p), p.y);
                return q;
            }
            vec3 centre = vec3(0.0, sphere.x, 0.0);
            precise vec3 q = shape_sphere_normal(p - centre) * sphere.y + centre;
            return q;
        }
        case SHAPE_CYLINDER: {
            ShapeCone side = shape_cylinder_side(shape);
            float size = 0.5 * shape.a;
            float face = shape_cylinder_face(shape, side, p);
            if (face != 0.0) {
                return vec3(p.x, face * size, p.z);
            }
            precise vec3 q = p - shape_cone_normal(side, p) * shape_cone_distance(side, shape_rho(p), p.y);
            return vec3(q.x, min(max(q.y, -size), size), q.z);
        }
        default: {
            vec3 gradient;
            float value = shape_field_value(shape, p, gradient);
            float square = shape_dot(gradient, gradient);
            vec3 step = gradient * (value / square);
            vec3 cell = 1.0 / shape_field_density(shape);
            float limit = 1e-3 * min(min(cell.x, cell.y), cell.z);
            if (square > 0.0 && shape_dot(step, step) <= limit * limit) {
                return min(max(p - step, -shape.box_max), shape.box_max);
            }
            return p;
        }
    }
}

#endif
