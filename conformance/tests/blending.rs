//! Blended surfaces are right on average: one layer and two, in one mesh and in two, for every type of ray.

use ambray::{Control, Renderer};
use ambray_core::settings::{Auto, Falloff, Settings, Size, Triple, Window};
use ambray_scene::{AlphaMode, Instance, Material, Mesh, Scene};
use glam::{Affine3A, Vec3, Vec4};

/// A square of half size 50 at the given height.
fn square(y: f32) -> [Vec3; 4] {
    [[-50.0, -50.0], [50.0, -50.0], [50.0, 50.0], [-50.0, 50.0]].map(|[x, z]| Vec3::new(x, y, z))
}

fn mesh(heights: &[f32], material: u32) -> Mesh {
    let positions = heights.iter().flat_map(|&y| square(y)).collect();
    let quads = (0..heights.len() as u32).map(|i| 4 * i);
    let triangles = quads.flat_map(|i| [[i, i + 1, i + 2], [i, i + 2, i + 3]]).collect();
    Mesh { positions, triangles, material, ..Mesh::default() }
}

/// Sheets of the given alpha over a floor: `layers` lists the heights of each mesh.
fn sheets(alpha: f32, layers: &[&[f32]]) -> Scene {
    let sheet = Material {
        base_color: Vec4::new(0.0, 0.0, 0.0, alpha),
        alpha_mode: AlphaMode::Blend,
        ..Material::default()
    };
    let mut meshes = vec![mesh(&[0.0], 0)];
    meshes.extend(layers.iter().map(|heights| mesh(heights, 1)));
    let instances = (0..meshes.len() as u32).map(|mesh| Instance {
        mesh,
        world_from_object: Affine3A::IDENTITY,
        ..Instance::default()
    });
    Scene {
        instances: instances.collect(),
        meshes: meshes.into_iter().map(Into::into).collect(),
        materials: vec![Material::default(), sheet],
        ..Scene::default()
    }
}

/// Share of the rays of each type that pass the sheets: from the camera, to the sky, to the sun.
fn transmittance(scene: Scene) -> [f32; 3] {
    let from = |height: f32| Settings {
        size: Size { width: 160, height: 160 },
        radius: Auto::Value(20.0),
        falloff: Falloff::Step,
        filter: Window::Off,
        sun_direction: Auto::Value(Triple([0.1, 1.0, 0.2])),
        camera_position: Auto::Value(Triple([0.3, height, 0.2])),
        camera_target: Auto::Value(Triple([0.31, 0.0, 0.22])),
        vertical_fov: Auto::Value(20.0),
        ..Settings::default()
    };
    let mut renderer = Renderer::new(scene);
    let mut render = |height: f32| {
        renderer.render(&from(height), Control::default()).unwrap_or_else(|error| panic!("{error}"))
    };
    // Above the sheets for primary rays; below them, on the floor, for the others.
    let (above, below) = (render(9.0), render(0.5));
    let count = below.gbuffer.len() as f32;
    let lit = below.gbuffer.iter().filter(|pixel| pixel.direct != Vec3::ZERO).count();
    [
        above.gbuffer.iter().filter(|pixel| pixel.instance == 0).count() as f32 / count,
        below.ambient_raw.iter().map(|v| v.x).sum::<f32>() / count,
        lit as f32 / count,
    ]
}

#[test]
fn transmittance_is_right_on_average() {
    for alpha in [0.25, 0.5, 0.75] {
        let one: &[&[f32]] = &[&[1.0]];
        for (name, layers, expected) in [
            ("one layer", one, 1.0 - alpha),
            ("two meshes", &[&[1.0], &[2.0]], (1.0 - alpha) * (1.0 - alpha)),
            ("two walls of one mesh", &[&[1.0, 2.0]], (1.0 - alpha) * (1.0 - alpha)),
        ] {
            for (ray, share) in
                ["primary", "ambient", "shadow"].iter().zip(transmittance(sheets(alpha, layers)))
            {
                assert!(
                    (share - expected).abs() < 0.015,
                    "alpha {alpha}, {name}, {ray} rays: {share} for {expected}"
                );
            }
        }
    }
}
