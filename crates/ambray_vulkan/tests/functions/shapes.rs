//! Shapes given by formulas: where rays meet them, normals, and points moved onto them. The shaders keep the order of all
//! operations, so that devices that round as processors do must give equal bits.

use ambray_core::{
    settings::Settings,
    shape::{Shape, SignedDistanceField},
};
use ambray_scene::Scene;
use ambray_vulkan::layout::{FUNCTION_SHAPE_RAY, FUNCTION_SHAPE_SURFACE};
use glam::Vec3;

use crate::{
    calls::{Call, Device, view},
    compare::Comparison,
    random::Random,
};

const RAYS: usize = 1000;

/// Share of the rays that may meet a shape on one side only, where ÷ and square roots are not exact: those that graze.
const GRAZING: f32 = 0.002;

fn field(samples: [u32; 3], size: Vec3, distance: impl FnMut(Vec3) -> f32) -> Shape {
    let [x, y, z] = samples;
    let points = (0..z).flat_map(|k| (0..y).flat_map(move |j| (0..x).map(move |i| [i, j, k])));
    let place = |p: [u32; 3]| {
        let at = |axis: usize| p[axis] as f32 / (samples[axis] - 1) as f32 - 0.5;
        Vec3::new(at(0), at(1), at(2)) * size
    };
    let distances = points.map(place).map(distance).collect();
    Shape::Field(SignedDistanceField::new(samples, size, distances).expect("a field"))
}

fn shapes(random: &mut Random) -> Vec<Shape> {
    let capsule = |height, radius_bottom, radius_top| Shape::Capsule { height, radius_bottom, radius_top };
    let cylinder = |height, radius_bottom, radius_top| Shape::Cylinder { height, radius_bottom, radius_top };
    let torus = |p: Vec3| {
        let ring = (p.x * p.x + p.z * p.z).sqrt() - 0.6;
        (ring * ring + p.y * p.y).sqrt() - 0.25
    };
    vec![
        Shape::Sphere { radius: 1.0 },
        Shape::Sphere { radius: 1e-3 },
        Shape::Sphere { radius: 70.0 },
        Shape::Box { half_extents: Vec3::ONE },
        Shape::Box { half_extents: Vec3::new(3.0, 0.01, 0.7) },
        capsule(2.0, 0.5, 0.5),
        capsule(1.0, 0.7, 0.2),
        capsule(1.0, 0.0, 0.4),
        // One sphere holds the other.
        capsule(0.5, 0.9, 0.3),
        capsule(0.0, 0.6, 0.6),
        capsule(30.0, 0.01, 1.0),
        cylinder(2.0, 0.5, 0.5),
        cylinder(1.0, 0.7, 0.2),
        cylinder(1.0, 0.2, 0.7),
        cylinder(1.5, 0.8, 0.0),
        cylinder(0.01, 3.0, 2.9),
        field([9, 8, 7], Vec3::new(2.4, 2.6, 2.2), |p| p.length() - 0.8),
        field([17, 9, 17], Vec3::new(2.0, 0.8, 2.0), torus),
        field([2, 2, 2], Vec3::ONE, |p| p.x + 0.3 * p.y * p.z),
        field([6, 5, 4], Vec3::new(1.0, 2.0, 3.0), |_| random.between(-1.0, 1.0)),
    ]
}

/// Rays from far away, from near by and from inside, and from the surface; towards the shape, past it, along axes, and
/// nearly tangential. Directions of any length.
fn ray(random: &mut Random, shape: &Shape) -> (Vec3, Vec3, f32) {
    let (low, high) = shape.bounds();
    let inside = |random: &mut Random, size: f32| {
        let share = random.vector(0.5 - 0.5 * size, 0.5 + 0.5 * size);
        low + (high - low) * share
    };
    let target = inside(random, 1.2);
    let extent = (high - low).max_element();
    let mut origin = match random.below(4) {
        0 => inside(random, 1.0),
        1 => inside(random, 1.5),
        2 => target + random.direction() * (extent * random.magnitude(-1.0, 4.0)),
        _ => target + random.direction() * (2.0 * extent),
    };
    let mut direction = target - origin;
    match random.below(6) {
        // Along an axis or a plane.
        0 => direction = random.direction() * extent,
        // From the surface, as ambient rays start.
        1 => {
            if let Some(t) = shape.intersect(origin, direction, f32::INFINITY) {
                origin = shape.project(origin + direction * t);
                let normal = shape.normal(origin);
                let along = random.direction().cross(normal);
                direction = along + normal * random.signed(-6.0, 0.0);
                origin += normal * (extent * 1e-5);
            }
        }
        _ => {}
    }
    if direction == Vec3::ZERO {
        direction = Vec3::X;
    }
    let t_max = match random.below(4) {
        0 => random.between(0.0, 2.0),
        1 => random.magnitude(-3.0, 3.0),
        _ => f32::INFINITY,
    };
    (origin, direction * random.magnitude(-1.0, 1.0), t_max)
}

#[test]
fn rays() {
    let mut random = Random::new(15);
    let scene = Scene { shapes: shapes(&mut random), ..Scene::default() };
    let Some(device) = Device::open(scene.clone()) else { return };
    let functions = device.functions(&Settings::default());
    let (mut hits, mut differ) = (0_u32, 0_u32);
    for (number, shape) in scene.shapes.iter().enumerate() {
        let arguments: Vec<_> = (0..RAYS).map(|_| ray(&mut random, shape)).collect();
        let calls: Vec<_> = (arguments.iter())
            .map(|&(o, d, t_max)| Call::default().word(number as u32).vector(o).vector(d).number(t_max))
            .collect();
        let mut distances = Comparison::new("distances along rays");
        let mut one_sided = 0;
        let (mut found, mut missed) = (0, 0);
        for (&(o, d, t_max), values) in
            arguments.iter().zip(functions.call(FUNCTION_SHAPE_RAY, &view(), &calls))
        {
            let expected = shape.intersect(o, d, t_max);
            let actual = (values.word(0) == 1).then(|| values.number(1));
            let what = || {
                format!("{o:?} + t {d:?}, t up to {t_max:e}: {actual:?} for {expected:?} of {}", name(shape))
            };
            match (expected, actual) {
                (Some(expected), Some(actual)) => {
                    found += 1;
                    let scale = expected.max(o.length() / d.length());
                    distances.add(expected, actual, scale, what);
                }
                (None, None) => missed += 1,
                _ => {
                    one_sided += 1;
                    assert!(!device.is_exact(), "{}", what());
                }
            }
        }
        assert!(
            found > RAYS / 8 && missed > RAYS / 32,
            "{found} hits and {missed} misses of {}",
            name(shape)
        );
        assert!(one_sided as f32 <= GRAZING * RAYS as f32, "{one_sided} rays of {}", name(shape));
        (hits, differ) = (hits + found as u32, differ + one_sided);
        // Roots of small differences where devices round differently.
        distances.finish(if device.is_exact() { 0.0 } else { 4096.0 });
    }
    println!("rays: {hits} hits, {differ} on one side only");
}

#[test]
fn points_of_surfaces() {
    let mut random = Random::new(16);
    let scene = Scene { shapes: shapes(&mut random), ..Scene::default() };
    let Some(device) = Device::open(scene.clone()) else { return };
    let functions = device.functions(&Settings::default());
    for (number, shape) in scene.shapes.iter().enumerate() {
        let size = shape.bounds().1.abs().max_element();
        let mut points = vec![Vec3::ZERO, Vec3::Y * size, Vec3::NEG_Y * size];
        while points.len() < RAYS {
            let (o, d, _) = ray(&mut random, shape);
            // Off the surface by rounding, as hits are, or anywhere.
            points.push(match shape.intersect(o, d, f32::INFINITY) {
                Some(t) if random.below(8) > 0 => o + d * t,
                _ => random.vector(-size, size),
            });
        }
        let calls: Vec<_> = points.iter().map(|&p| Call::default().word(number as u32).vector(p)).collect();
        let (mut normals, mut projections) = (Comparison::new("normals"), Comparison::new("projections"));
        for (&p, values) in points.iter().zip(functions.call(FUNCTION_SHAPE_SURFACE, &view(), &calls)) {
            let what = || format!("{p:?} of {}", name(shape));
            normals.add_vector(shape.normal(p), values.vector(0), 1.0, what);
            projections.add_vector(shape.project(p), values.vector(3), p.length().max(size), what);
        }
        // Points between two parts of a surface may belong to either where devices round differently.
        if device.is_exact() {
            normals.finish(0.0);
            projections.finish(0.0);
        } else {
            projections.finish(64.0);
        }
    }
}

/// A field without its samples.
fn name(shape: &Shape) -> String {
    match shape {
        Shape::Field(field) => format!("a field of {:?}", field.samples()),
        other => format!("{other:?}"),
    }
}
