//! Shapes against closed forms, and against marching along implicit functions in double precision.

use ambray_core::{
    sampling::{DEFAULT_SEEDS, owen_point, pcg, unit_float},
    shape::{FieldError, Shape, SignedDistanceField},
};
use glam::{DVec2, DVec3, Vec3};

const SPHERE: Shape = Shape::Sphere { radius: 1.5 };
const BOX: Shape = Shape::Box { half_extents: Vec3::new(1.0, 0.25, 2.0) };

fn capsule(height: f32, radius_bottom: f32, radius_top: f32) -> Shape {
    Shape::Capsule { height, radius_bottom, radius_top }
}

fn cylinder(height: f32, radius_bottom: f32, radius_top: f32) -> Shape {
    Shape::Cylinder { height, radius_bottom, radius_top }
}

fn convex_shapes() -> Vec<Shape> {
    vec![
        SPHERE,
        BOX,
        capsule(2.0, 0.5, 0.5),
        capsule(2.0, 1.0, 0.25),
        capsule(2.0, 0.25, 1.0),
        capsule(2.0, 0.0, 0.75),
        capsule(1.0, 1.5, 0.25),
        capsule(0.0, 0.5, 0.5),
        capsule(8.0, 0.05, 0.1),
        cylinder(2.0, 0.5, 0.5),
        cylinder(2.0, 1.0, 0.25),
        cylinder(2.0, 0.25, 1.0),
        cylinder(2.0, 1.0, 0.0),
        cylinder(0.1, 1.0, 3.0),
        cylinder(8.0, 0.05, 0.1),
    ]
}

/// Signed distance, or what has its sign and its zeros.
fn implicit(shape: &Shape, p: DVec3) -> f64 {
    let rho = DVec2::new(p.x, p.z).length();
    match *shape {
        Shape::Sphere { radius } => p.length() - f64::from(radius),
        Shape::Box { half_extents } => (p.abs() - half_extents.as_dvec3()).max_element(),
        Shape::Capsule { height, radius_bottom, radius_top } => {
            // A sphere rolls up the axis while its radius changes: the hull is the union of all of them.
            let (h, r1, r2) = (f64::from(height), f64::from(radius_bottom), f64::from(radius_top));
            if h <= (r1 - r2).abs() {
                let (y, r) = if r1 >= r2 { (-0.5 * h, r1) } else { (0.5 * h, r2) };
                return (p - DVec3::Y * y).length() - r;
            }
            let sin = (r1 - r2) / h;
            let at = (p.y - rho * sin / (1.0 - sin * sin).sqrt()).clamp(-0.5 * h, 0.5 * h);
            let radius = 0.5 * (r1 + r2) - sin * at;
            DVec2::new(rho, p.y - at).length() - radius
        }
        Shape::Cylinder { height, radius_bottom, radius_top } => {
            let (h, r1, r2) = (f64::from(height), f64::from(radius_bottom), f64::from(radius_top));
            let slant = h.hypot(r1 - r2);
            let side = (rho - 0.5 * (r1 + r2)) * h / slant + p.y * (r1 - r2) / slant;
            side.max(p.y.abs() - 0.5 * h)
        }
        Shape::Field(ref field) => {
            let n = field.samples();
            let (low, high) = shape.bounds();
            let cells = DVec3::new(f64::from(n[0] - 1), f64::from(n[1] - 1), f64::from(n[2] - 1));
            let g = (p - low.as_dvec3()) / (high - low).as_dvec3() * cells;
            let corner = g.floor().clamp(DVec3::ZERO, cells - 1.0);
            let f = g - corner;
            let mut sum = 0.0;
            for i in 0..8 {
                let bit = |axis: usize| i >> axis & 1;
                let at = |axis: usize| corner[axis] as usize + bit(axis);
                let weight = |axis: usize| if bit(axis) == 1 { f[axis] } else { 1.0 - f[axis] };
                let index = (at(2) * n[1] as usize + at(1)) * n[0] as usize + at(0);
                sum += f64::from(field.distances()[index]) * weight(0) * weight(1) * weight(2);
            }
            sum
        }
    }
}

struct Random(u32);

impl Random {
    fn unit(&mut self) -> f32 {
        self.0 = pcg(self.0.wrapping_add(0x9E37_79B9));
        unit_float(self.0)
    }

    fn cube(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }
}

/// First sign change on the way from `from` to `to` in steps of a `steps`-th, as a share of the way.
fn march(f: impl Fn(DVec3) -> f64, from: DVec3, to: DVec3, steps: u32) -> Option<f64> {
    let value = |s: f64| f(from.lerp(to, s));
    let before = value(0.0) < 0.0;
    let step = (1..=steps).find(|&i| (value(f64::from(i) / f64::from(steps)) < 0.0) != before)?;
    let (mut low, mut high) = (f64::from(step - 1) / f64::from(steps), f64::from(step) / f64::from(steps));
    for _ in 0..50 {
        let middle = 0.5 * (low + high);
        if (value(middle) < 0.0) == before {
            low = middle;
        } else {
            high = middle;
        }
    }
    Some(0.5 * (low + high))
}

/// Rays through the shape's box, from within and from without, against marching.
fn check_against_marching(shape: &Shape, rays: u32, steps: u32) {
    let (low, high) = shape.bounds();
    let size = high - low;
    let reach = size.max_element();
    let mut random = Random(7);
    let (mut hits, mut disputed) = (0, 0);
    for i in 0..rays {
        let target = low + size * (0.5 * random.cube() + 0.5);
        let from = if i % 2 == 0 {
            low + size * (0.5 * random.cube() + 0.5)
        } else {
            (low + high) * 0.5 + random.cube().normalize() * (reach * (1.0 + 9.0 * random.unit()))
        };
        // Not of unit length, and some along an axis.
        let mut direction = (target - from) * (0.1 + random.unit());
        if i % 7 == 0 {
            direction.x = 0.0;
        }
        if i % 11 == 0 {
            direction.z = 0.0;
        }
        if i % 13 == 0 {
            direction.y = 0.0;
        }
        if direction == Vec3::ZERO {
            continue;
        }
        let end = 20.0 * reach / direction.length();
        let hit = shape.intersect(from, direction, end);
        let (o, d) = (from.as_dvec3(), direction.as_dvec3());
        let f = |p: DVec3| implicit(shape, p);
        if f(o).abs() < 1e-5 * f64::from(reach) {
            continue;
        }
        // Nothing is there beyond the samples of a field.
        let (mut first, mut last) = (0.0_f64, f64::from(end));
        if matches!(shape, Shape::Field(_)) {
            let (a, b) = ((low.as_dvec3() - o) / d, (high.as_dvec3() - o) / d);
            let through = |axis: usize| d[axis] != 0.0;
            for axis in (0..3).filter(|&axis| through(axis)) {
                first = first.max(a[axis].min(b[axis]));
                last = last.min(a[axis].max(b[axis]));
            }
            let misses = (0..3)
                .any(|axis| !through(axis) && (o[axis] < low[axis].into() || o[axis] > high[axis].into()));
            if misses || first >= last {
                assert_eq!(hit, None);
                continue;
            }
        }
        let expected = march(f, o + d * first, o + d * last, steps).map(|s| first + s * (last - first));
        let tolerance = 1e-4 * f64::from(reach) / f64::from(direction.length());
        match (hit, expected) {
            (Some(t), Some(expected)) if (f64::from(t) - expected).abs() <= tolerance => hits += 1,
            (None, None) => {}
            // Marching steps over thin parts, and rounding decides where rays just touch: what was found must be there.
            (Some(t), expected) if expected.is_none_or(|expected| f64::from(t) < expected) => {
                let p = o + d * f64::from(t);
                assert!(f(p).abs() < 2e-5 * f64::from(reach), "{shape:?}: {from} {direction} {t}: {}", f(p));
                disputed += 1;
            }
            other => {
                // A ray that misses a corner by rounding.
                let depth = (0..400).map(|k| {
                    let t = expected.unwrap_or_default() + tolerance * 10.0 * (f64::from(k) / 200.0 - 1.0);
                    f(o + d * t)
                });
                let (low, high) = depth.fold((f64::MAX, f64::MIN), |(l, h), v| (l.min(v), h.max(v)));
                assert!(
                    low.abs().min(high.abs()) < 1e-5 * f64::from(reach),
                    "{shape:?}: {from} {direction}: {other:?}"
                );
                disputed += 1;
            }
        }
    }
    assert!(hits > rays / 8, "{shape:?}: {hits} of {rays}");
    assert!(disputed <= rays / 50, "{shape:?}: {disputed} of {rays} disputed");
}

#[test]
fn convex_shapes_against_marching() {
    for shape in convex_shapes() {
        check_against_marching(&shape, 800, 8000);
    }
}

#[track_caller]
fn check(shape: &Shape, origin: [f32; 3], direction: [f32; 3], expected: Option<f32>) {
    let t = shape.intersect(origin.into(), direction.into(), f32::INFINITY);
    match (t, expected) {
        (Some(t), Some(expected)) => {
            assert!((t - expected).abs() <= 4e-7 * expected.max(1.0), "{t} is not {expected}")
        }
        (t, expected) => assert_eq!(t, expected),
    }
}

#[test]
fn distances_in_closed_form() {
    check(&SPHERE, [0.0, 0.0, 5.0], [0.0, 0.0, -1.0], Some(3.5));
    check(&SPHERE, [0.0, 0.0, 5.0], [0.0, 0.0, -0.5], Some(7.0));
    check(&SPHERE, [0.0, 0.0, 0.0], [0.0, 0.0, -1.0], Some(1.5));
    check(&SPHERE, [0.0, 0.0, 5.0], [0.0, 0.0, 1.0], None);
    check(&SPHERE, [0.9, 0.0, 5.0], [0.0, 0.0, -1.0], Some(3.8));
    check(&BOX, [0.5, 3.0, -1.0], [0.0, -1.0, 0.0], Some(2.75));
    check(&BOX, [0.5, 0.0, -1.0], [1.0, 0.0, 0.0], Some(0.5));
    check(&BOX, [1.5, 0.0, -1.0], [0.0, 1.0, 0.0], None);
    let even = capsule(2.0, 0.5, 0.5);
    check(&even, [0.0, 5.0, 0.0], [0.0, -1.0, 0.0], Some(3.5));
    check(&even, [2.0, 0.5, 0.0], [-1.0, 0.0, 0.0], Some(1.5));
    check(&even, [2.0, 1.3, 0.0], [-1.0, 0.0, 0.0], Some(1.6));
    check(&even, [0.0, 0.0, 0.0], [0.0, 0.0, 1.0], Some(0.5));
    // Radii 1.2 and 0 at a distance of 2: the sine of the side is 0.6, and at y = 0 its radius is 0.6 / 0.8.
    let taper = capsule(2.0, 1.2, 0.0);
    check(&taper, [3.0, 0.0, 0.0], [-1.0, 0.0, 0.0], Some(2.25));
    check(&taper, [0.0, 3.0, 0.0], [0.0, -1.0, 0.0], Some(2.0));
    check(&taper, [0.0, -3.0, 0.0], [0.0, 1.0, 0.0], Some(0.8));
    let cone = cylinder(2.0, 1.0, 0.0);
    check(&cone, [3.0, 0.0, 0.0], [-1.0, 0.0, 0.0], Some(2.5));
    check(&cone, [0.5, -3.0, 0.0], [0.0, 1.0, 0.0], Some(2.0));
    check(&cone, [0.5, 3.0, 0.0], [0.0, -1.0, 0.0], Some(3.0));
    // Along a generator's direction, through the inside.
    check(&cone, [0.0, -2.0, 0.0], [0.5, 1.0, 0.0], Some(1.0));
    // The other nappe is not there.
    check(&cone, [3.0, 1.5, 0.0], [-1.0, 0.0, 0.0], None);
    check(&cone, [0.2, 0.5, 0.0], [0.0, 1.0, 0.0], Some(0.1));
    let tube = cylinder(2.0, 0.5, 0.5);
    check(&tube, [0.3, 0.0, 0.0], [0.0, 1.0, 0.0], Some(1.0));
    check(&tube, [0.3, 0.0, 0.0], [0.0, 0.0, 1.0], Some(0.4));
}

#[test]
fn far_origins_keep_the_precision_of_their_distance() {
    let mut random = Random(3);
    let shapes = [Shape::Sphere { radius: 1.0 }, capsule(1.0, 0.5, 0.5), cylinder(2.0, 0.5, 0.5)];
    for shape in shapes {
        for _ in 0..2000 {
            let target = random.cube() * 0.2;
            let direction = random.cube().normalize();
            let origin = target - direction * 1000.0;
            let t = shape.intersect(origin, direction, f32::INFINITY).expect("aimed at its middle");
            let p = origin.as_dvec3() + direction.as_dvec3() * f64::from(t);
            assert!(implicit(&shape, p).abs() < 2e-3, "{shape:?} {origin}: {}", implicit(&shape, p));
        }
    }
}

#[test]
fn limits_of_the_ray() {
    let ray = (Vec3::new(0.0, 0.0, 5.0), Vec3::NEG_Z);
    assert_eq!(SPHERE.intersect(ray.0, ray.1, 3.0), None);
    assert_eq!(SPHERE.intersect(ray.0, ray.1, 3.5), Some(3.5));
    // On the surface itself: outwards is free, inwards crosses to the other side.
    let top = Vec3::new(0.0, 0.0, 1.5);
    assert_eq!(SPHERE.intersect(top, Vec3::Z, f32::INFINITY), None);
    assert_eq!(SPHERE.intersect(top, Vec3::NEG_Z, f32::INFINITY), Some(3.0));
}

#[test]
fn degenerate_capsules_are_spheres() {
    let mut random = Random(11);
    for (capsule, radius) in [(capsule(0.0, 0.5, 0.5), 0.5), (capsule(0.0, 0.2, 0.7), 0.7)] {
        let sphere = Shape::Sphere { radius };
        assert_eq!(capsule.bounds(), sphere.bounds());
        for _ in 0..1000 {
            let (o, d) = (random.cube(), random.cube());
            let far = |shape: &Shape| shape.intersect(o, d, f32::INFINITY);
            if o.length() > 0.7 {
                assert_eq!(far(&capsule), far(&sphere));
            }
        }
    }
}

#[test]
fn projected_points_lie_on_the_surface_and_normals_are_gradients() {
    let mut random = Random(5);
    let mut shapes = convex_shapes();
    shapes.push(round_field(32));
    for shape in shapes {
        let (low, high) = shape.bounds();
        let reach = low.abs().max(high.abs()).max_element();
        for _ in 0..2000 {
            let from = (random.cube() + Vec3::splat(0.01)).normalize() * (3.0 * reach);
            let direction = (low + (high - low) * (0.5 * random.cube() + 0.5)) - from;
            let Some(t) = shape.intersect(from, direction, f32::INFINITY) else { continue };
            let hit = from + direction * t;
            let p = shape.project(hit);
            let left = implicit(&shape, p.as_dvec3()).abs();
            assert!(left <= 4e-7 * f64::from(reach), "{shape:?} at {p}: {left}");
            assert!(p.distance(hit) <= 1e-5 * reach, "{shape:?}: {hit} moved to {p}");
            let h = 1e-6 * f64::from(reach);
            let slope = |axis: DVec3| {
                implicit(&shape, p.as_dvec3() + axis * h) - implicit(&shape, p.as_dvec3() - axis * h)
            };
            let gradient = DVec3::new(slope(DVec3::X), slope(DVec3::Y), slope(DVec3::Z)).normalize();
            let normal = shape.normal(p);
            assert!((normal.length() - 1.0).abs() < 1e-6);
            let along = normal.as_dvec3().dot(gradient);
            // Two normals meet at edges, at tips and between cells.
            let edge = (along - 1.0).abs() > 1e-3;
            let near_edge = || {
                let side = |axis: Vec3| shape.normal(shape.project(p + axis * 2e-5 * reach));
                [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z]
                    .iter()
                    .any(|&axis| side(axis).distance(normal) > 1e-3)
            };
            assert!(!edge || near_edge(), "{shape:?} at {p}: {normal} is not {gradient}");
        }
    }
}

/// Distances from a sphere of radius 0.8 in a box of size 2.
fn round_field(n: u32) -> Shape {
    let at = |i: u32| 2.0 * i as f32 / (n - 1) as f32 - 1.0;
    let all = (0..n * n * n).map(|i| Vec3::new(at(i % n), at(i / n % n), at(i / n / n)).length() - 0.8);
    Shape::Field(SignedDistanceField::new([n; 3], Vec3::splat(2.0), all.collect()).expect("a field"))
}

#[test]
fn fields_against_marching() {
    let mut random = Random(17);
    let noise: Vec<f32> = (0..4 * 5 * 3).map(|_| random.unit() - 0.4).collect();
    let field = SignedDistanceField::new([4, 5, 3], Vec3::new(1.0, 2.0, 0.5), noise).expect("a field");
    check_against_marching(&Shape::Field(field), 3000, 20_000);
    check_against_marching(&round_field(16), 1500, 4000);
}

#[test]
fn a_linear_field_is_a_plane() {
    let n = [5_u32, 9, 3];
    let distances = (0..n[0] * n[1] * n[2]).map(|i| 0.25 * (i / n[0] % n[1]) as f32 - 0.9).collect();
    let field = SignedDistanceField::new(n, Vec3::new(4.0, 2.0, 4.0), distances).expect("a field");
    let field = Shape::Field(field);
    // The height of the zero: 0.9 of 2 units above −1.
    check(&field, [0.3, 3.0, 0.4], [0.0, -1.0, 0.0], Some(3.1));
    check(&field, [0.3, -0.95, 0.4], [0.0, 0.5, 0.0], Some(1.7));
    check(&field, [0.3, 0.5, 0.4], [1.0, 0.1, 0.2], None);
    check(&field, [-1.9, 0.1, 1.9], [0.3, -0.1, -0.3], Some(2.0));
    assert_eq!(field.normal(Vec3::new(0.3, -0.1, 0.4)), Vec3::Y);
    let p = field.project(Vec3::new(0.3, -0.100_01, 0.4));
    assert!(p.abs_diff_eq(Vec3::new(0.3, -0.1, 0.4), 2e-7), "{p}");
}

#[test]
fn rays_pass_no_crossing_between_cells() {
    // Zeros exactly on the planes of the grid, and rays exactly along and through its planes, edges and corners.
    let n = 9;
    let distances = (0..n * n * n).map(|i| (i % n) as f32 - 4.0).collect();
    let field = SignedDistanceField::new([n; 3], Vec3::splat(8.0), distances).expect("a field");
    let field = Shape::Field(field);
    for y in -4..=4 {
        for z in -4..=4 {
            check(&field, [-9.0, y as f32, z as f32], [1.0, 0.0, 0.0], Some(9.0));
            check(&field, [9.0, y as f32, z as f32], [-1.0, 0.0, 0.0], Some(9.0));
        }
    }
    check(&field, [-4.0, -4.0, -4.0], [1.0, 1.0, 1.0], Some(4.0));
    let mut random = Random(23);
    for _ in 0..20_000 {
        let (y, z) = (random.unit() - 0.5, random.unit() - 0.5);
        let (from, to) = (Vec3::new(-5.0, 5.0 * y, -4.0 * z), Vec3::new(3.0, 3.0 * z, 6.0 * y));
        assert!(field.intersect(from, to - from, 1.0).is_some());
        assert!(field.intersect(to, from - to, 1.0).is_some());
    }
}

#[test]
fn bad_fields_are_refused() {
    let new = |n, size, count| SignedDistanceField::new(n, Vec3::splat(size), vec![0.0; count]);
    assert_eq!(new([1, 2, 2], 1.0, 4), Err(FieldError::Samples));
    assert_eq!(new([4097, 2, 2], 1.0, 4), Err(FieldError::Samples));
    assert_eq!(new([2, 2, 2], 0.0, 8), Err(FieldError::Size));
    assert_eq!(new([2, 2, 2], f32::NAN, 8), Err(FieldError::Size));
    assert_eq!(new([2, 2, 2], 1.0, 7), Err(FieldError::Count));
    let nan = SignedDistanceField::new([2; 3], Vec3::ONE, vec![f32::NAN; 8]);
    assert_eq!(nan, Err(FieldError::NotFinite));
}

#[test]
fn a_sphere_covers_its_share_of_the_sky() {
    // Radius 1 seen from a distance of 2: an angular radius of 30°.
    let sphere = Shape::Sphere { radius: 1.0 };
    const COUNT: u32 = 1 << 18;
    let seen = (0..COUNT).filter(|&i| {
        let [u, v] = owen_point(i, DEFAULT_SEEDS).map(unit_float);
        let (y, (sin, cos)) = (1.0 - 2.0 * u, (std::f32::consts::TAU * v).sin_cos());
        let r = (1.0 - y * y).sqrt();
        let direction = Vec3::new(r * cos, y, r * sin);
        sphere.intersect(Vec3::new(0.0, 0.0, 2.0), direction, f32::INFINITY).is_some()
    });
    let share = seen.count() as f64 / f64::from(COUNT);
    assert!((share - 0.5 * (1.0 - 0.75_f64.sqrt())).abs() < 5e-4, "{share}");
}
