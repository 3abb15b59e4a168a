//! Shapes given by formulas, through the whole renderer, against closed forms.

use ambray::{Control, Frame, QueryPoint, Renderer};
use ambray_core::{
    settings::{Auto, Falloff, Settings, Size, Thin, Triple, Window},
    shape::Shape,
};
use ambray_scene::{Instance, Material, Mesh, Scene, ShapeInstance};
use glam::{Affine3A, Quat, Vec3};

/// Crisp visibility within a radius that holds the whole scene.
fn unlimited(radius: f32) -> Settings {
    Settings {
        spp: 4096,
        falloff: Falloff::Step,
        radius: Auto::Value(radius),
        thin: Thin::Off,
        filter: Window::Off,
        ..Settings::default()
    }
}

fn scene(placed: &[(Shape, Affine3A)]) -> Scene {
    let instance = |i: usize| ShapeInstance {
        shape: i as u32,
        world_from_object: placed[i].1,
        ..ShapeInstance::default()
    };
    Scene {
        shapes: placed.iter().map(|(shape, _)| shape.clone()).collect(),
        shape_instances: (0..placed.len()).map(instance).collect(),
        materials: vec![Material::default()],
        ..Scene::default()
    }
}

/// Mean and variance of the mean of the openness at one point, over 64 points that differ by nothing but their samples.
fn openness(renderer: &mut Renderer, settings: &Settings, position: Vec3, normal: Vec3) -> (f64, f64) {
    let mut values = Vec::new();
    for seed in 0..16 {
        let settings = Settings { seed, ..settings.clone() };
        let points: Vec<_> =
            (0..4).map(|class| QueryPoint { position, normal, class: class * 4 + 1 }).collect();
        let results = renderer.query(&settings, &points, Control::default());
        let results = results.unwrap_or_else(|error| panic!("{error}"));
        values.extend(results.iter().map(|result| f64::from(result.openness)));
    }
    let count = values.len() as f64;
    let mean = values.iter().sum::<f64>() / count;
    (mean, values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (count * (count - 1.0)))
}

/// A sphere of angular radius α that is all above the horizon, tilted by θ from the zenith, takes cos θ sin² α of the
/// openness: its projected solid angle over π.
#[test]
fn a_sphere_above_a_point() {
    for (sine, tilt) in [(0.5_f32, 0.0_f32), (0.5, 0.6), (0.25, 1.2), (0.8, 0.3), (0.05, 0.9)] {
        let direction = Vec3::new(tilt.sin(), tilt.cos(), 0.0);
        for scale in [0.01_f32, 1.0, 100.0] {
            // Also where it is a scaled and turned sphere far from the origin.
            for far in [Vec3::ZERO, Vec3::new(30.0, -20.0, 50.0)] {
                let placement = Affine3A::from_scale_rotation_translation(
                    Vec3::splat(2.0 * scale),
                    Quat::from_rotation_x(1.0),
                    (direction + far) * scale,
                );
                let mut renderer = Renderer::new(scene(&[(Shape::Sphere { radius: 0.5 * sine }, placement)]));
                let (position, settings) = (far * scale, unlimited(1e3 * scale));
                let (mean, variance) = openness(&mut renderer, &settings, position, Vec3::Y);
                // Rays leave from where their offset puts them, which is nearer to the sphere.
                let view = renderer.view(&settings).unwrap_or_else(|error| panic!("{error}"));
                let origin = view.offset.apply(position, Vec3::Y, position.abs().max_element());
                let way = Vec3::from(placement.translation).as_dvec3() - origin.as_dvec3();
                let sine = f64::from(sine) * f64::from(scale) / way.length();
                let expected = 1.0 - way.normalize().y * sine * sine;
                assert!(
                    (mean - expected).abs() < 3.0 * variance.sqrt() + 1e-6,
                    "sin {sine}, tilt {tilt}, {scale}, {far}: {mean} ± {} for {expected}",
                    variance.sqrt()
                );
            }
        }
    }
}

/// A disc parallel to the surface takes r² / (r² + h²) of the openness above its middle; a cylinder's lower face is one, and
/// hides the rest of it.
#[test]
fn the_lower_face_of_a_cylinder() {
    for (height, bottom, top) in [(1.0_f32, 0.5_f32, 0.5_f32), (3.0, 0.8, 0.2), (0.1, 2.0, 0.0)] {
        let shape = Shape::Cylinder { height, radius_bottom: bottom, radius_top: top };
        let placement = Affine3A::from_translation(Vec3::Y * (1.0 + 0.5 * height));
        let mut renderer = Renderer::new(scene(&[(shape, placement)]));
        let (mean, variance) = openness(&mut renderer, &unlimited(1e3), Vec3::ZERO, Vec3::Y);
        let square = f64::from(bottom * bottom);
        let expected = 1.0 - square / (square + 1.0);
        assert!((mean - expected).abs() < 3.0 * variance.sqrt() + 1e-6, "{mean} for {expected}");
    }
}

fn render(scene: Scene, settings: &Settings, eye: Vec3, target: Vec3) -> Frame {
    let settings = Settings {
        size: Size { width: 64, height: 64 },
        spp: 64,
        camera_position: Auto::Value(Triple::from(eye)),
        camera_target: Auto::Value(Triple::from(target)),
        ..settings.clone()
    };
    Renderer::new(scene).render(&settings, Control::default()).unwrap_or_else(|error| panic!("{error}"))
}

fn solids(size: f32) -> [Shape; 5] {
    [
        Shape::Sphere { radius: size },
        Shape::Box { half_extents: Vec3::new(1.0, 0.6, 0.8) * size },
        Shape::Capsule { height: size, radius_bottom: 0.7 * size, radius_top: 0.3 * size },
        Shape::Cylinder { height: size, radius_bottom: 0.7 * size, radius_top: 0.7 * size },
        Shape::Cylinder { height: size, radius_bottom: 0.8 * size, radius_top: 0.3 * size },
    ]
}

/// Nothing shades a convex thing that is alone: O = 1 at every pixel that shows it, exactly.
#[test]
fn convex_things_do_not_shade_themselves() {
    for size in [0.01, 1.0, 1000.0] {
        for far in [0.0, 100.0] {
            for shape in solids(size) {
                let turn = Quat::from_scaled_axis(Vec3::new(0.3, 1.0, -0.4));
                let middle = Vec3::new(0.7, -0.4, 0.2) * far * size;
                let placement = Affine3A::from_rotation_translation(turn, middle);
                let scene = scene(&[(shape.clone(), placement)]);
                let eye = middle + Vec3::new(1.0, 1.5, 2.0) * size;
                let frame = render(scene, &unlimited(10.0 * size), eye, middle);
                let seen = (0..frame.gbuffer.len()).filter(|&i| frame.gbuffer[i].is_surface());
                let shaded = seen.clone().filter(|&i| frame.ambient_raw[i].x != 1.0).count();
                assert_eq!(shaded, 0, "{shape:?} at {middle}");
                assert!(seen.count() > 400, "{shape:?}");
            }
        }
    }
}

/// From within, nothing of a closed thing is open.
#[test]
fn closed_things_are_closed_from_within() {
    for shape in &solids(2.0)[..4] {
        let middle = Vec3::new(3.0, -5.0, 8.0);
        let placement = Affine3A::from_rotation_translation(Quat::from_rotation_z(0.4), middle);
        let frame = render(scene(&[(shape.clone(), placement)]), &unlimited(100.0), middle, middle + Vec3::X);
        assert!(frame.gbuffer.iter().all(|pixel| pixel.is_surface()), "{shape:?}");
        let open = frame.ambient_raw.iter().filter(|ambient| ambient.x != 0.0).count();
        assert_eq!(open, 0, "{shape:?}");
    }
}

/// Shapes and the triangles that they rest on see each other.
#[test]
fn a_sphere_rests_on_triangles() {
    let mut scene = scene(&[(Shape::Sphere { radius: 1.0 }, Affine3A::from_translation(Vec3::Y))]);
    let corner = |x: f32, z: f32| Vec3::new(x, 0.0, z) * 1e4;
    let floor = Mesh {
        positions: vec![corner(-1.0, -1.0), corner(-1.0, 1.0), corner(1.0, 1.0), corner(1.0, -1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Mesh::default()
    };
    scene.meshes.push(floor.into());
    scene.instances.push(Instance::default());
    let mut renderer = Renderer::new(scene);
    for x in [0.5_f32, 1.0, 3.0] {
        // On the floor: the sphere touches the horizon's plane, so all of it is above: sin α = 1 / √(x² + 1), cos θ the same.
        let (mean, variance) = openness(&mut renderer, &unlimited(1e3), Vec3::X * x, Vec3::Y);
        let sine = 1.0 / (f64::from(x) * f64::from(x) + 1.0).sqrt();
        let expected = 1.0 - sine * sine * sine;
        assert!((mean - expected).abs() < 3.0 * variance.sqrt() + 1e-4, "{x}: {mean} for {expected}");
    }
    // On the sphere at height 1, half of the sky is floor: the normal is level.
    let (mean, variance) = openness(&mut renderer, &unlimited(1e3), Vec3::new(1.0, 1.0, 0.0), Vec3::X);
    assert!((mean - 0.5).abs() < 3.0 * variance.sqrt() + 1e-3, "{mean}");
}
