//! Recorded rays are those of the frame, each where its tag says.

use std::sync::Arc;

use ambray::{
    Control, Frame, GBufferPixel, RenderError, Renderer,
    cpu::rays::{FrameRays, LeftOut, Order, RayBatch, RayKind, Triangles},
    scene::{AlphaMode, Instance, Material, Mesh, Scene, atrium::atrium, surface::Surfaces},
    settings::{Auto, NearRadiance, Settings, Size, Thin, Triple},
    trace::{Hit, Ray},
};
use ambray_core::trace::Trace as _;
use ambray_cpu::{Opaque, Tracer};
use glam::{Affine3A, Vec3};

/// Neither side is a multiple of a tile's.
const SIZE: Size = Size { width: 75, height: 45 };

fn settings() -> Settings {
    Settings { size: SIZE, ..Settings::default() }
}

/// The atrium's renderer, its frame and its rays, with `settings`.
fn recorded(settings: &Settings) -> (Renderer, Frame, FrameRays) {
    let mut renderer = Renderer::new(atrium());
    let frame = renderer.render(settings, Control::default()).unwrap();
    let rays = renderer.record_rays(settings, Control::default()).unwrap();
    (renderer, frame, rays)
}

/// Number of a ray in its pixel, with the ray.
fn rays_of(batch: &RayBatch, pixel: u32) -> Vec<(u32, Ray)> {
    let tags = batch.tags.iter().zip(&batch.rays);
    let mut rays: Vec<_> = tags
        .filter(|(tag, _)| **tag / batch.per_pixel == pixel)
        .map(|(tag, ray)| (tag % batch.per_pixel, *ray))
        .collect();
    rays.sort_by_key(|(number, _)| *number);
    rays
}

fn seen(frame: &Frame) -> impl Iterator<Item = (u32, &GBufferPixel)> {
    (0..).zip(&frame.gbuffer).filter(|(_, pixel)| pixel.is_surface())
}

#[test]
fn as_many_rays_are_recorded_as_a_frame_traces() {
    // 33: a tile takes more than one batch.
    for spp in [1, 5, 33] {
        let settings = Settings { spp, ..settings() };
        let (mut renderer, frame, rays) = recorded(&settings);
        assert_eq!(rays.primary.rays.len() as u64, frame.stats.rays.primary);
        assert_eq!(rays.ambient.rays.len() as u64, frame.stats.rays.ambient);
        for (thin, chords) in [(Thin::Paper, &rays.paper_chords), (Thin::Sheet, &rays.sheet_chords)] {
            let settings = Settings { thin, ..settings.clone() };
            let stats = renderer.measure(&settings, Control::default()).unwrap();
            assert_eq!(chords.rays.len() as u64, stats.rays.chord, "{thin:?}, {spp} rays");
            // Whatever thin detection the settings ask for, all rays are recorded.
            assert_eq!(renderer.record_rays(&settings, Control::default()).unwrap(), rays);
        }
    }
}

#[test]
fn hits_of_recorded_rays_give_the_openness_of_the_frame() {
    let settings = settings();
    let (renderer, frame, rays) = recorded(&settings);
    let hits = renderer.closest_hits(&rays.ambient.rays).unwrap();
    // The sums of the gather: blocked at once below the horizon, where no ray is traced.
    let mut open = vec![vec![0.0; settings.spp as usize]; frame.gbuffer.len()];
    for (tag, hit) in rays.ambient.tags.iter().zip(&hits) {
        let (pixel, number) = (tag / rays.ambient.per_pixel, tag % rays.ambient.per_pixel);
        let distance = if hit.is_hit() { hit.t } else { f32::INFINITY };
        open[pixel as usize][number as usize] = f64::from(frame.view.openness.at(distance));
    }
    for (pixel, _) in seen(&frame) {
        let sum: f64 = open[pixel as usize].iter().sum();
        let openness = (sum / f64::from(settings.spp)) as f32;
        assert_eq!(openness, frame.ambient_raw[pixel as usize].x, "pixel {pixel}");
    }
    assert_eq!((rays.ambient.kind, rays.ambient.per_pixel), (RayKind::Closest, settings.spp));
}

#[test]
fn primary_rays_end_where_the_frame_looks() {
    let (renderer, frame, rays) = recorded(&settings());
    let hits = renderer.closest_hits(&rays.primary.rays).unwrap();
    let mut tags = rays.primary.tags.clone();
    for ((&tag, ray), hit) in rays.primary.tags.iter().zip(&rays.primary.rays).zip(&hits) {
        let pixel = &frame.gbuffer[tag as usize];
        assert_eq!(hit.is_hit(), pixel.is_surface());
        if hit.is_hit() {
            let end = ray.origin + hit.t * ray.direction;
            assert!(end.distance(pixel.position) < 1e-4 * hit.t.max(1.0), "{end} and {}", pixel.position);
        }
    }
    tags.sort_unstable();
    assert!(tags.iter().copied().eq(0..SIZE.width * SIZE.height));
    // The first tile, row by row.
    assert_eq!(rays.primary.tags[..3], [0, 1, 2]);
    assert_eq!(rays.primary.tags[16], SIZE.width);
}

#[test]
fn chords_join_the_ends_of_the_rays_that_their_numbers_name() {
    let settings = settings();
    let (_, frame, rays) = recorded(&settings);
    let pairs: Vec<[u32; 2]> =
        (0..settings.spp).flat_map(|a| (a + 1..settings.spp).map(move |b| [a, b])).collect();
    let radius = frame.view.radius;
    let mut met = 0;
    for (batch, reach) in [(&rays.paper_chords, radius), (&rays.sheet_chords, 0.5 * radius)] {
        assert_eq!(batch.per_pixel as usize, pairs.len());
        for (pixel, surface) in seen(&frame).step_by(7) {
            let ambient = rays_of(&rays.ambient, pixel);
            let direction = |number: u32| {
                let of = |(n, ray): &(u32, Ray)| (*n == number).then_some(ray.direction);
                ambient.iter().find_map(of).expect("only rays that were traced can miss")
            };
            for (number, chord) in rays_of(batch, pixel) {
                let ends = pairs[number as usize].map(|j| surface.position + direction(j) * reach);
                let length = ends[0].distance(ends[1]);
                // Chords of `sheet` begin at the end of the smaller azimuth.
                let [from, to] = if chord.origin == ends[0] { ends } else { [ends[1], ends[0]] };
                assert_eq!(chord.origin, from, "pixel {pixel}, pair {number}");
                assert!((chord.direction - (to - from) / length).length() < 1e-5);
                assert!((chord.t_max / length - (1.0 - 1e-4)).abs() < 1e-5);
                met += 1;
            }
        }
    }
    assert!(met > 1000, "{met}");
    assert_eq!([rays.paper_chords.kind, rays.sheet_chords.kind], [RayKind::Any, RayKind::Closest]);
}

/// A floor of two triangles, seen from above at a slant.
fn floor() -> (Scene, Settings) {
    let corners = [[-9.0, 0.0, -9.0], [9.0, 0.0, -9.0], [9.0, 0.0, 9.0], [-9.0, 0.0, 9.0]];
    let mesh = Mesh {
        positions: corners.map(Vec3::from).to_vec(),
        triangles: vec![[0, 2, 1], [0, 3, 2]],
        ..Mesh::default()
    };
    let scene = Scene {
        meshes: vec![Arc::new(mesh)],
        instances: vec![Instance::default()],
        materials: vec![Material::default()],
        ..Scene::default()
    };
    let settings = Settings {
        camera_position: Auto::Value(Triple([0.0, 3.0, 4.0])),
        camera_target: Auto::Value(Triple([0.0, 0.0, 0.0])),
        radius: Auto::Value(1.0),
        ..settings()
    };
    (scene, settings)
}

#[test]
fn on_a_floor_rays_of_one_class_and_number_are_parallel() {
    let (scene, settings) = floor();
    let mut renderer = Renderer::new(scene);
    let rays = renderer.record_rays(&settings, Control::default()).unwrap();
    for batch in [&rays.ambient, &rays.paper_chords, &rays.sheet_chords] {
        let (indices, tiles) = batch.ordered(Order::Deinterleaved);
        let mut runs = 0;
        for tile in tiles {
            for run in indices[tile].chunk_by(|&a, &b| {
                let [a, b] = [a, b].map(|i| batch.tags[i as usize]);
                let class = |tag| {
                    let (x, y) = batch.pixel(tag);
                    (x % 4, y % 4, tag % batch.per_pixel)
                };
                class(a) == class(b)
            }) {
                let first = batch.rays[run[0] as usize].direction;
                for &i in run {
                    let other = batch.rays[i as usize].direction;
                    assert!(first.dot(other) > 1.0 - 1e-5, "{first} and {other}");
                }
                runs += 1;
            }
        }
        assert!(runs > 100);
    }
}

#[test]
fn triangles_give_the_hits_of_the_scene() {
    // Nothing masked, so that the files hold all that the frame sees.
    let mut scene = atrium();
    scene.remove_transparent();
    assert!(scene.shape_instances.is_empty());
    let (triangles, left_out) =
        Triangles::of(&scene, &Surfaces::new(Arc::new(scene.clone()))).expect("few corners");
    assert_eq!(left_out, LeftOut::default());
    let mut renderer = Renderer::new(scene);
    let rays = renderer.record_rays(&settings(), Control::default()).unwrap();
    let expected = renderer.closest_hits(&rays.ambient.rays).unwrap();
    let tracer = Tracer::build(&triangles.into_scene(), Opaque, ambray::BuildOptions::default());
    let mut hits = vec![Hit::MISS; expected.len()];
    tracer.closest_hits(&rays.ambient.rays, &mut hits);
    assert!(expected.iter().any(Hit::is_hit));
    for (hit, expected) in hits.iter().zip(&expected) {
        assert_eq!((hit.t, hit.u, hit.v), (expected.t, expected.u, expected.v));
    }
}

#[test]
fn masked_triangles_are_left_out_and_counted() {
    let (mut scene, _) = floor();
    let masked = Material { alpha_mode: AlphaMode::Mask(0.5), ..Material::default() };
    let see_through = Material { base_color: glam::Vec4::new(1.0, 1.0, 1.0, 0.2), ..masked };
    let mesh = Mesh { material: 1, ..(*scene.meshes[0]).clone() };
    scene.materials.push(see_through);
    scene.meshes.push(Arc::new(mesh));
    let raised = Affine3A::from_translation(Vec3::Y);
    scene.instances.push(Instance { mesh: 1, world_from_object: raised, ..Instance::default() });
    let (triangles, left_out) =
        Triangles::of(&scene, &Surfaces::new(Arc::new(scene.clone()))).expect("few corners");
    assert_eq!((triangles.indices.len(), left_out), (2, LeftOut { masked: 2, shapes: 0 }));
    scene.remove_transparent();
    assert_eq!(scene.instances.len(), 1);
}

#[test]
fn more_rays_than_tags_are_an_error() {
    let (scene, settings) = floor();
    // 75 x 45 pixels with 2048 x 2047 / 2 pairs each.
    let settings = Settings { spp: 2048, near_radiance: NearRadiance::Off, ..settings };
    let error = Renderer::new(scene).record_rays(&settings, Control::default()).unwrap_err();
    assert!(matches!(error, RenderError::TooManyRays(_)), "{error}");
    assert!(error.to_string().contains("2^32"), "{error}");
}
