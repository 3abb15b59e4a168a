//! The golden values of the method (crates/ambray_core/tests/golden) on a device, by both ways to trace.
//!
//! The processor's tests trace worlds of planes, discs and spheres in double precision. Here quads and triangles are meshes,
//! spheres are procedural shapes, discs are fans of many triangles, and planes are quads that reach farther than rays count.
//! Not here: golden values of single functions, which are compared with their twins in `tests/functions`, and of the filter,
//! whose twin is compared on whole frames.

#[path = "../common/mod.rs"]
mod common;
mod geometry;

use std::sync::Arc;

use ambray_core::{
    camera::{Camera, Projection},
    control::Control,
    offset::RayOffset,
    openness::Openness,
    query::{QueryPoint, QueryResult},
    settings::{Falloff, NearRadiance, RadianceSource, Sampling, Sequence, Settings, Thin},
    view::View,
};
use ambray_vulkan::{Context, TraceMode, VulkanBackend, VulkanOptions};
use common::{assert_valid, context};
use geometry::{list, number, scene, vec3};
use glam::{Vec2, Vec3};
use serde_json::Value;

fn golden(name: &str) -> Value {
    let path = format!("{}/../ambray_core/tests/golden/{name}.json", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(&path).unwrap_or_else(|error| panic!("{path}: {error}"));
    serde_json::from_str(&text).unwrap_or_else(|error| panic!("{path}: {error}"))
}

fn measure(value: &Value) -> (Falloff, Openness) {
    let field = |name: &str| number(&value[name]) as f32;
    match value["kind"].as_str().expect("a kind") {
        "poly" => (Falloff::Power, Openness::Power { radius: field("R"), exponent: field("alpha") }),
        "exp" => (Falloff::Exponential, Openness::Exponential { sigma: field("sigma") }),
        "exp_trunc" => (
            Falloff::ExponentialTruncated,
            Openness::ExponentialTruncated { radius: field("R"), sigma: field("sigma") },
        ),
        "step" => (Falloff::Step, Openness::Step { radius: field("R") }),
        other => panic!("unknown measure {other}"),
    }
}

/// Backends for the world of `case`; the first ones keep the programs.
fn open(first: &[VulkanBackend], case: &Value) -> Vec<VulkanBackend> {
    let (_, openness) = measure(&case["mu"]);
    // What is beyond 20 lengths of an exponential adds less than 1e-8.
    let reach = match openness {
        Openness::Exponential { sigma } => 20.0 / sigma,
        other => 2.0 * other.reach(),
    };
    let scene = Arc::new(scene(&case["geometry"], vec3(&case["point"]), reach));
    (first.iter())
        .map(|first| first.with_scene(&scene, &Control::default()).unwrap_or_else(|error| panic!("{error}")))
        .collect()
}

/// A backend for each way to trace that the device has.
fn backends(context: &Arc<Context>) -> Vec<VulkanBackend> {
    let modes = [(context.has_pipelines(), TraceMode::Pipeline), (context.has_queries(), TraceMode::Query)];
    let open = |trace: TraceMode| {
        let options = VulkanOptions { trace, ..VulkanOptions::default() };
        VulkanBackend::new(context, &Arc::default(), options, &Control::default())
            .unwrap_or_else(|error| panic!("{error}"))
    };
    modes.into_iter().filter(|(has, _)| *has).map(|(_, mode)| open(mode)).collect()
}

/// As the golden values want it: one set of Owen points, the colours of surfaces as their radiance, no second batch.
fn settings(case: &Value, spp: u32) -> Settings {
    Settings {
        spp,
        falloff: measure(&case["mu"]).0,
        sampling: Sampling::Same,
        sequence: Sequence::Owen,
        near_radiance: NearRadiance::Averaged,
        radiance_source: RadianceSource::Albedo,
        thin: Thin::Off,
        thin_edge: false,
        ..Settings::default()
    }
}

fn evaluate(backend: &VulkanBackend, settings: &Settings, case: &Value) -> QueryResult {
    let openness = measure(&case["mu"]).1;
    let projection = Projection::Perspective { vertical_fov: 1.0 };
    let view = View {
        camera: Camera::new(Vec3::ZERO, Vec3::NEG_Z, Vec3::Y, projection, 1, 1),
        camera_origin: String::new(),
        radius: case["mu"].get("R").map_or(1.0, |r| number(r) as f32),
        openness,
        near_limit: case.get("limit").map_or(openness.reach(), |limit| number(limit) as f32),
        ambient: Vec3::ONE,
        background: Vec3::ZERO,
        offset: RayOffset::UNIT,
        lights: Vec::new(),
    };
    let point = QueryPoint { position: vec3(&case["point"]), normal: vec3(&case["normal"]), class: 0 };
    let results = backend.query(settings, &view, &[point], Control::default());
    results.unwrap_or_else(|error| panic!("{error}"))[0]
}

/// Closed forms and quadrature, within the tolerances of Owen points (spec §9).
#[test]
fn openness_and_near_radiance() {
    let Some(context) = context() else { return };
    let first = backends(&context);
    let (spp, tolerance) = (4096, 3e-3);
    let (mut count, mut largest) = (0, 0.0_f32);
    for file in ["planes", "interiors", "occluders", "colour", "general"] {
        for case in list(&golden(file)["cases"]) {
            let quantity = case["quantity"].as_str().expect("a quantity");
            let near_radiance = match quantity {
                "I_avg" => NearRadiance::AveragedPlain,
                "I_hit" if count % 2 == 0 => NearRadiance::PerHit,
                // With weights 1 - μ the average is the sum per hit (spec §3).
                _ => NearRadiance::Averaged,
            };
            for backend in open(&first, case) {
                let settings = Settings { near_radiance, ..settings(case, spp) };
                let result = evaluate(&backend, &settings, case);
                let error = if quantity == "O" {
                    (f64::from(result.openness) - number(&case["value"])).abs() as f32
                } else {
                    (result.near_radiance - vec3(&case["value"])).abs().max_element()
                };
                let what = format!("{file} {} {:?}", case["id"], backend.trace_mode());
                assert!(error < tolerance, "{what}: error {error}");
                largest = largest.max(error);
            }
            count += 1;
        }
    }
    println!("{count} cases, off by {largest} at most");
    assert_eq!(count, 76);
    assert_valid(&context);
}

/// Thin-object detection for given directions, chords counted one by one (spec §8).
#[test]
fn thin_objects() {
    let Some(context) = context() else { return };
    let first = backends(&context);
    let file = golden("thin");
    for case in list(&file["cases"]) {
        let points: Vec<Vec2> = (list(&case["xi"]).iter())
            .map(|xi| Vec2::new(number(&xi[0]) as f32, number(&xi[1]) as f32))
            .collect();
        for backend in open(&first, case) {
            let what = format!("{} {:?}", case["id"], backend.trace_mode());
            let close = |value: f32, name: &str| {
                assert!((f64::from(value) - number(&case[name])).abs() < 1e-4, "{what} {name}: {value}");
            };
            let count = |name: &str| case[name].as_u64().expect("a number") as u32;
            let evaluate = |thin: Thin, thin_edge: bool| {
                let settings = Settings { thin, thin_edge, ..settings(case, points.len() as u32) };
                backend.give_samples(&settings, &points).unwrap_or_else(|error| panic!("{error}"));
                evaluate(&backend, &settings, case)
            };
            let paper = evaluate(Thin::Paper, false);
            close(paper.first_batch, "openness_first");
            close(paper.second_batch, "paper_A2");
            close(paper.openness, "paper_openness");
            assert_eq!(
                (paper.chord_rays, paper.chord_hits),
                (count("pairs"), count("pairs_blocked")),
                "{what}"
            );
            assert_eq!(paper.ambient_rays - paper.ambient_hits, count("misses"), "{what}");
            let sheet = evaluate(Thin::Sheet, false);
            close(sheet.second_batch, "opposite_A2");
            close(sheet.openness, "opposite_openness");
            assert_eq!(sheet.chord_rays, count("opposite_pairs"), "{what}");
            close(evaluate(Thin::Sheet, true).openness, "opposite_edge_openness");
        }
    }
    assert_eq!(list(&file["cases"]).len(), 11);
    assert_valid(&context);
}
