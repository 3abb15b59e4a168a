use glam::Vec3;

use super::{banner, flock};
use crate::animation::{Clips, Moment, Rig};
use crate::{Motion, Scene};

fn rig(scene: &Scene) -> &Rig {
    scene.rig.as_deref().expect("a rig")
}

/// The scene at `time` of its clip.
fn at(scene: &Scene, time: f64) -> Scene {
    let mut moved = scene.clone();
    let pose = rig(scene).pose(Some(&Moment { clips: Clips::One(0), time, repeat: true }));
    moved.place(&pose);
    moved.deform(&pose);
    moved
}

fn check_sound(scene: &Scene) {
    for mesh in &scene.meshes {
        mesh.validate().unwrap_or_else(|error| panic!("{}: {error}", mesh.name));
        assert!((mesh.material as usize) < scene.materials.len());
        assert!(mesh.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-5), "{}", mesh.name);
    }
    for instance in &scene.instances {
        assert!(instance.world_from_object.inverse().is_finite());
    }
}

/// Sound at several times, and a loop.
fn check(scene: &Scene, bounds: (Vec3, Vec3)) {
    let duration = f64::from(rig(scene).clips[0].duration);
    for share in [0.0, 0.1, 0.25, 0.4, 0.5, 0.7, 0.9] {
        let moved = at(scene, share * duration);
        check_sound(&moved);
        let (lo, hi) = moved.bounds().expect("something");
        assert!(lo.cmpge(bounds.0).all() && hi.cmple(bounds.1).all(), "{share}: {lo} {hi}");
    }
    let (start, end) = (at(scene, 0.0), at(scene, duration));
    assert!((&start.instances, &start.meshes) == (&end.instances, &end.meshes), "a loop");
    assert!((&start.instances, &start.meshes) == (&scene.instances, &scene.meshes), "at rest as it begins");
}

#[test]
fn the_banner_deforms_strongly() {
    let scene = banner();
    assert!((40_000..=50_000).contains(&scene.triangle_count()), "{}", scene.triangle_count());
    check(&scene, (Vec3::new(-4.01, -0.3, -4.01), Vec3::new(4.01, 4.5, 4.01)));
    let deformer = &rig(&scene).deformers[0];
    let mesh = |scene: &Scene| scene.meshes[deformer.mesh as usize].clone();
    assert!(mesh(&scene).triangles.len() > 30_000);
    for time in [0.5, 1.0, 1.5, 2.0, 2.5, 3.0, 3.5] {
        let moved = mesh(&at(&scene, time));
        let far = moved.positions.iter().zip(&deformer.positions).filter(|(a, b)| a.distance(**b) > 0.25);
        assert!(far.count() > moved.positions.len() / 4, "at {time} s");
        let lowest = moved.positions.iter().map(|p| p.y).fold(f32::INFINITY, f32::min);
        assert!(lowest > 0.0, "{lowest} at {time} s: above the floor");
    }
}

#[test]
fn the_flock_flies() {
    let scene = flock();
    let moving = |scene: &Scene| scene.instances.iter().filter(|i| i.motion == Motion::Rigid).count();
    assert_eq!(moving(&scene), 2000);
    assert!((350_000..=600_000).contains(&scene.triangle_count()), "{}", scene.triangle_count());
    check(&scene, (Vec3::new(-7.0, -0.3, -7.0), Vec3::new(7.0, 4.5, 7.0)));
    let places = |scene: &Scene| -> Vec<Vec3> {
        scene.instances.iter().map(|i| i.world_from_object.translation.into()).collect()
    };
    let mut far = 0;
    for (a, b) in places(&at(&scene, 1.0)).iter().zip(places(&at(&scene, 3.0))) {
        far += usize::from(a.distance(b) > 0.3);
    }
    assert!(far > 1900, "{far}");
    for mesh in scene.meshes.iter().filter(|mesh| ["fish", "bird", "ring", "ball"].contains(&&*mesh.name)) {
        assert!((100..=500).contains(&mesh.triangles.len()), "{}: {}", mesh.name, mesh.triangles.len());
    }
}
