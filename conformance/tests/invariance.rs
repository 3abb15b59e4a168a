//! What must not change the picture: threads, runs, motion, scale and order; and what must change it in one direction.

use std::sync::Arc;

use ambray::{BuildOptions, Control, Frame, Renderer};
use ambray_core::settings::{Auto, Settings, Size, Thin, Triple};
use ambray_scene::{Instance, Material, Mesh, Scene};
use glam::{Affine3A, Mat3, Quat, Vec3};

/// A floor with a few boxes, and a hanging sheet.
fn scene() -> Scene {
    let mut meshes = vec![quad([-4.0, 0.0, -4.0], [0.0, 0.0, 8.0], [8.0, 0.0, 0.0])];
    for i in 0..5 {
        let (x, z) = (i as f32 * 1.1 - 2.3, (i * i % 3) as f32 - 1.2);
        meshes.extend(cuboid(Vec3::new(x, 0.0, z), Vec3::new(0.5, 0.4 + 0.3 * i as f32, 0.6)));
    }
    meshes.push(quad([-2.0, 0.05, 1.6], [0.0, 1.5, 0.0], [3.0, 0.0, 0.3]));
    let instances = (0..meshes.len() as u32).map(|mesh| Instance {
        mesh,
        world_from_object: Affine3A::IDENTITY,
        ..Instance::default()
    });
    let instances = instances.collect();
    let meshes = meshes.into_iter().map(Arc::new).collect();
    Scene { instances, meshes, materials: vec![Material::default()], ..Scene::default() }
}

fn quad(origin: [f32; 3], u: [f32; 3], v: [f32; 3]) -> Mesh {
    let (o, u, v) = (Vec3::from(origin), Vec3::from(u), Vec3::from(v));
    let triangles = vec![[0, 1, 2], [0, 2, 3]];
    Mesh { positions: vec![o, o + u, o + u + v, o + v], triangles, ..Mesh::default() }
}

fn cuboid(o: Vec3, size: Vec3) -> Vec<Mesh> {
    let (x, y, z) = (Vec3::X * size.x, Vec3::Y * size.y, Vec3::Z * size.z);
    let face = |o: Vec3, u: Vec3, v: Vec3| quad(o.into(), u.into(), v.into());
    vec![face(o, x, y), face(o + z, x, y), face(o, z, y), face(o + x, z, y), face(o, x, z), face(o + y, x, z)]
}

fn settings() -> Settings {
    Settings {
        size: Size { width: 160, height: 96 },
        radius: Auto::Value(0.8),
        thin: Thin::Sheet,
        camera_position: Auto::Value(Triple([1.5, 2.5, 5.0])),
        camera_target: Auto::Value(Triple([-0.2, 0.4, 0.0])),
        sun_direction: Auto::Value(Triple([0.3, 1.0, 0.4])),
        ..Settings::default()
    }
}

fn render(scene: Scene, settings: &Settings, threads: usize) -> Frame {
    let control = Control { threads, ..Control::default() };
    Renderer::new(scene).render(settings, control).unwrap_or_else(|error| panic!("{error}"))
}

#[test]
fn threads_and_runs_give_the_same_bits() {
    let one = render(scene(), &settings(), 1);
    for threads in [1, 2, 3, 7] {
        let other = render(scene(), &settings(), threads);
        assert_eq!(one.beauty, other.beauty, "{threads} threads");
        assert_eq!(one.ambient, other.ambient, "{threads} threads");
        assert_eq!(one.stats.rays, other.stats.rays, "{threads} threads");
    }
}

#[test]
fn order_of_triangles_does_not_matter() {
    let mut reversed = scene();
    for mesh in &mut reversed.meshes {
        let mesh = Arc::make_mut(mesh);
        mesh.triangles.reverse();
        mesh.triangles.iter_mut().for_each(|t| t.rotate_left(1));
    }
    reversed.instances.reverse();
    reversed.meshes.reverse();
    let (a, b) = (render(scene(), &settings(), 0), render(reversed, &settings(), 0));
    let (mean, most) = difference(&a, &b);
    assert!(mean < 1e-4 && most < 1e-3, "mean {mean}, share beyond 1e-3 {most}");
}

/// Mean difference of openness, and the share of pixels that differ by more than 1e-3.
fn difference(a: &Frame, b: &Frame) -> (f32, f32) {
    let differences: Vec<f32> = a.ambient.iter().zip(&b.ambient).map(|(a, b)| (a.x - b.x).abs()).collect();
    let count = differences.len() as f32;
    let beyond = differences.iter().filter(|&&d| d > 1e-3).count() as f32;
    (differences.iter().sum::<f32>() / count, beyond / count)
}

/// Mean openness of the frame under a motion and a scale of everything in it.
fn moved(scale: f32, rotation: Quat, translation: Vec3) -> (Frame, Frame) {
    let placement = Affine3A::from_mat3_translation(Mat3::from_quat(rotation) * scale, translation);
    let mut scene = scene();
    for instance in &mut scene.instances {
        instance.world_from_object = placement;
    }
    let base = settings();
    let point =
        |v: &Auto<Triple>| v.value().map(|&v| placement.transform_point3(v.into())).expect("it is set");
    let direction = |v: Vec3| Auto::Value(Triple::from(rotation * v));
    let settings = Settings {
        radius: Auto::Value(0.8 * scale),
        camera_position: Auto::Value(point(&base.camera_position).into()),
        camera_target: Auto::Value(point(&base.camera_target).into()),
        camera_up: direction(Vec3::Y),
        sun_direction: direction(Vec3::new(0.3, 1.0, 0.4)),
        spp: 256,
        ..base.clone()
    };
    let still = Settings { spp: 256, ..base };
    (render(self::scene(), &still, 0), render(scene, &settings, 0))
}

#[test]
fn motion_and_scale_do_not_matter() {
    // Rotation turns the sample sets about the normals, so single pixels differ by the noise of 256 rays.
    let turn = Quat::from_euler(glam::EulerRot::XYZ, 0.4, 1.1, -0.7);
    for (name, scale, rotation, translation, mean_bar) in [
        ("millimetres", 0.001, Quat::IDENTITY, Vec3::ZERO, 1e-4),
        ("kilometres", 1000.0, Quat::IDENTITY, Vec3::ZERO, 1e-4),
        ("moved", 1.0, Quat::IDENTITY, Vec3::new(3.0, -2.0, 10.0), 1e-3),
        ("turned", 1.0, turn, Vec3::ZERO, 2e-3),
        // At 1e5 units single precision places vertices to 0.008 only: the scene itself is coarser.
        ("far", 1.0, Quat::IDENTITY, Vec3::splat(1e5), 1e-2),
    ] {
        let (still, moved) = moved(scale, rotation, translation);
        let (mean, _) = difference(&still, &moved);
        assert!(mean < mean_bar, "{name}: mean difference {mean}");
    }
}

#[test]
fn more_geometry_never_opens() {
    let settings = Settings { thin: Thin::Off, filter: ambray_core::settings::Window::Off, ..settings() };
    let full = render(scene(), &settings, 0);
    let mut less = scene();
    less.instances.pop();
    let less = render(less, &settings, 0);
    let same_surface = |i: &usize| full.gbuffer[*i].position == less.gbuffer[*i].position;
    let opened =
        (0..full.ambient.len()).filter(same_surface).filter(|&i| full.ambient[i].x > less.ambient[i].x);
    assert_eq!(opened.count(), 0);
}

/// One open quad of any size and slant, seen near the origin, is fully open: no ray hits the surface it starts on.
#[test]
fn slanted_floors_do_not_shadow_themselves() {
    for half in [10.0_f32, 40.0, 1e3, 1e4] {
        for turn in 0..6 {
            let angle = turn as f32;
            let rotation = Quat::from_euler(glam::EulerRot::XYZ, 0.3 + angle, 0.7 * angle, 0.2 - angle);
            let (u, v) = (rotation * Vec3::X * half, rotation * Vec3::Z * half);
            // Off the origin, or symmetry would hide rounding.
            let centre = rotation * Vec3::new(0.31, 0.0, -0.17) * half;
            let positions = vec![centre - u - v, centre + u - v, centre + u + v, centre - u + v];
            let mesh = Mesh { positions, triangles: vec![[0, 1, 2], [0, 2, 3]], ..Mesh::default() };
            // Also placed twice, near and far below, and traced in object space: rounding happens elsewhere there.
            for copies in [1, 2] {
                let options = BuildOptions { bake_budget: 0, ..BuildOptions::default() };
                let away = Affine3A::from_translation(rotation * Vec3::Y * -3.0 * half);
                let placements = [Affine3A::IDENTITY, away];
                let scene = Scene {
                    meshes: vec![Arc::new(mesh.clone())],
                    instances: placements[..copies]
                        .iter()
                        .map(|&world_from_object| Instance {
                            mesh: 0,
                            world_from_object,
                            ..Instance::default()
                        })
                        .collect(),
                    materials: vec![Material::default()],
                    ..Scene::default()
                };
                let settings = Settings {
                    size: Size { width: 48, height: 48 },
                    radius: Auto::Value(1.0),
                    camera_position: Auto::Value((rotation * Vec3::Y * 2.0).into()),
                    camera_target: Auto::Value((rotation * Vec3::new(0.01, 0.0, 0.02)).into()),
                    ..Settings::default()
                };
                let mut renderer = Renderer::on_cpu(scene, options);
                let frame =
                    renderer.render(&settings, Control::default()).unwrap_or_else(|error| panic!("{error}"));
                let wrong = frame.ambient_raw.iter().filter(|v| v.x != 1.0).count();
                assert_eq!(wrong, 0, "half size {half}, orientation {turn}, {copies} instances");
            }
        }
    }
}
