//! Scenes with a closed form, through the whole renderer, on every backend: visibility with unlimited rays, furnaces, leaks.

use ambray::{Control, QueryPoint, QueryResult, Renderer};
use ambray_core::settings::{Auto, Falloff, NearRadiance, RadianceSource, Rgb, Settings};
use conformance::{backends, shared};
use glam::Vec3;

fn query(renderer: &mut Renderer, settings: &Settings, position: Vec3, normal: Vec3) -> QueryResult {
    let point = QueryPoint { position, normal, class: 0 };
    renderer.query(settings, &[point], Control::default()).unwrap_or_else(|error| panic!("{error}"))[0]
}

/// Crisp visibility within a radius that holds the whole scene.
fn unlimited(radius: f32) -> Settings {
    Settings { spp: 4096, falloff: Falloff::Step, radius: Auto::Value(radius), ..Settings::default() }
}

#[track_caller]
fn check(name: &str, value: f32, expected: f32, tolerance: f32) {
    assert!((value - expected).abs() < tolerance, "{name}: {value} for {expected}");
}

/// Tolerance of 4096 Owen rays (spec §9).
const TOLERANCE: f32 = 3e-3;

#[test]
fn right_angle_at_every_scale() {
    let files = [
        ("Analytic/right_angle_h1.glb", 1.0, Vec3::ZERO, TOLERANCE),
        ("Analytic/right_angle_h1_millimetres.glb", 0.001, Vec3::ZERO, TOLERANCE),
        // Coordinates of 3e4 are exact to 2e-3 in single precision, so the wall and the point are that far off.
        ("Analytic/right_angle_h1_far.glb", 1.0, Vec3::new(20_000.0, 0.0, -30_000.0), 2.0 * TOLERANCE),
    ];
    for (file, scale, origin, tolerance) in files {
        let Some(scene) = shared::load(file) else { return };
        backends::each(scene, |renderer| {
            for d in [0.25_f32, 1.0, 2.0] {
                let at = origin + Vec3::X * (d * scale);
                let result = query(renderer, &unlimited(300.0 * scale), at, Vec3::Y);
                check(
                    &format!("{file} at {d}"),
                    result.openness,
                    0.5 * (1.0 + (1.0 / d).atan().cos()),
                    tolerance,
                );
            }
        });
    }
}

#[test]
fn sphere_over_plane() {
    let Some(scene) = shared::load("Analytic/sphere_over_plane.glb") else { return };
    backends::each(scene, |renderer| {
        for p in [0.0_f32, 1.0, 2.0] {
            let result = query(renderer, &unlimited(200.0), Vec3::X * p, Vec3::Y);
            check(&format!("at {p}"), result.openness, 1.0 - 2.0 / (p * p + 4.0).powf(1.5), TOLERANCE);
        }
    });
}

#[test]
fn closed_rooms_are_closed() {
    for (file, positions) in [
        (
            "Analytic/closed_room.glb",
            [Vec3::new(1.0, 0.0, 1.0), Vec3::new(-1.5, 0.0, -1.5), Vec3::new(1.9, 0.0, 1.9)],
        ),
        (
            "Analytic/furnace_box.glb",
            [Vec3::new(0.0, -1.0, 0.0), Vec3::new(0.9, -1.0, -0.9), Vec3::new(-0.5, -1.0, 0.2)],
        ),
    ] {
        let Some(scene) = shared::load(file) else { return };
        backends::each(scene, |renderer| {
            for position in positions {
                assert_eq!(
                    query(renderer, &unlimited(100.0), position, Vec3::Y).openness,
                    0.0,
                    "{file} at {position}"
                );
            }
        });
    }
}

/// In a closed box of albedo 1/2 each point gathers exactly 1/2 of the uniform radiance L_a = 1 in one bounce.
#[test]
fn furnace() {
    let Some(scene) = shared::load("Analytic/furnace_box.glb") else { return };
    backends::each(scene, |renderer| {
        for near_radiance in [NearRadiance::Averaged, NearRadiance::AveragedPlain, NearRadiance::PerHit] {
            let settings = Settings { near_radiance, spp: 64, ..unlimited(100.0) };
            let result = query(renderer, &settings, Vec3::new(0.3, -1.0, 0.4), Vec3::Y);
            assert!(
                result.near_radiance.abs_diff_eq(Vec3::splat(0.5), 1e-5),
                "{near_radiance:?}: {}",
                result.near_radiance
            );
        }
    });
}

#[test]
fn walls_bleed_their_colours() {
    let Some(scene) = shared::load("Analytic/closed_room.glb") else { return };
    backends::each(scene, |renderer| {
        let settings = Settings { spp: 1024, radius: Auto::Value(2.0), ..Settings::default() };
        let left = query(renderer, &settings, Vec3::new(-1.8, 0.0, 1.5), Vec3::Y).near_radiance;
        let right = query(renderer, &settings, Vec3::new(1.8, 0.0, 1.5), Vec3::Y).near_radiance;
        assert!(left.x > 1.5 * left.y, "left is not red: {left}");
        assert!(right.y > 1.5 * right.x, "right is not green: {right}");
    });
}

/// Not a single ray passes the partition of zero thickness: no red beyond it.
#[test]
fn two_rooms_leak_nothing() {
    let Some(scene) = shared::load("Analytic/two_rooms_zero_thickness.glb") else { return };
    backends::each(scene, |renderer| {
        let base = Settings { spp: 1024, radius: Auto::Value(20.0), ..Settings::default() };
        for source in [RadianceSource::Ambient, RadianceSource::SelfSimilar, RadianceSource::Lit] {
            for x in [1e-4, 1e-3, 0.01, 0.1, 1.0, 3.0] {
                for z in [-2.9, -1.0, 0.0, 2.0] {
                    let settings = Settings {
                        radiance_source: source,
                        ambient: Auto::Value(Rgb([1.0; 3])),
                        ..base.clone()
                    };
                    let near = query(renderer, &settings, Vec3::new(x, 0.0, z), Vec3::Y).near_radiance;
                    assert!(
                        near.x == near.y && near.x == near.z && near.x > 0.0,
                        "{source:?}: {near} at {x}, {z}"
                    );
                }
            }
        }
    });
}

/// Sheets of every thickness darken wall and floor behind them alike.
#[test]
fn thin_sheets_darken_alike() {
    let Some(scene) = shared::load("Analytic/thin_sheets.glb") else { return };
    backends::each(scene, |renderer| {
        let settings = Settings { radius: Auto::Value(1.0), spp: 1024, ..Settings::default() };
        // Behind the middle of each sheet: single-sided, double-sided, 1 mm, 1 cm.
        let wall: Vec<f32> = [-4.0, -2.0, 0.0, 2.0]
            .map(|x| query(renderer, &settings, Vec3::new(x, 1.1, -0.3), Vec3::Z).openness)
            .into();
        let floor: Vec<f32> = [-4.0, -2.0, 0.0, 2.0]
            .map(|x| query(renderer, &settings, Vec3::new(x, 0.0, -0.15), Vec3::Y).openness)
            .into();
        for values in [&wall, &floor] {
            let (low, high) = values.iter().fold((1.0_f32, 0.0_f32), |(lo, hi), &v| (lo.min(v), hi.max(v)));
            assert!(high - low < 0.03 && high < 0.7, "{values:?}");
        }
        // A sheet without thickness must not let through more than a solid one: its two kinds are equal.
        check("single- and double-sided", wall[0], wall[1], 1e-3);
    });
}

#[test]
fn degenerate_triangles_do_no_harm() {
    let Some(scene) = shared::load("Analytic/degenerate_triangles.glb") else { return };
    backends::each(scene, |renderer| {
        let frame = renderer
            .render(&Settings::default(), Control::default())
            .unwrap_or_else(|error| panic!("{error}"));
        assert!(frame.beauty.iter().all(|v| v.is_finite()));
    });
}

/// Two floors in one place: no speckle, and nothing of the one darkens the other.
#[test]
fn coincident_floors_are_stable() {
    let Some(scene) = shared::load("Analytic/coplanar_duplicates.glb") else { return };
    backends::each(scene, |renderer| {
        let settings = Settings { radius: Auto::Value(0.5), ..unlimited(0.5) };
        let open = query(renderer, &settings, Vec3::new(1.5, 0.0, 1.5), Vec3::Y);
        assert_eq!(open.openness, 1.0);
        let frame = renderer
            .render(&Settings::default(), Control::default())
            .unwrap_or_else(|error| panic!("{error}"));
        let seen: std::collections::BTreeSet<_> = frame
            .gbuffer
            .iter()
            .filter(|p| p.position.y.abs() < 1e-6 && p.is_surface())
            .map(|p| p.instance)
            .collect();
        assert_eq!(seen.len(), 1, "the floor seen flickers between instances {seen:?}");
    });
}
