//! Openness and near radiance against closed forms and quadrature: 76 cases (spec §9).

mod common;

use ambray_core::{
    gather::Gathered,
    sampling::SampleSets,
    settings::{NearRadiance, Sampling, Sequence},
};
use common::{gather_at, golden, list, number, vec3};
use serde_json::Value;

fn evaluate(case: &Value, spp: u32, near_radiance: NearRadiance) -> Gathered {
    let samples = SampleSets::new(Sampling::Same, Sequence::Owen, spp, 0, 0);
    gather_at(case, &samples, |params| {
        params.near_radiance = near_radiance;
        params.near_limit = case.get("limit").map_or(params.near_limit, |limit| number(limit) as f32);
    })
}

fn check(file: &str, count: usize) {
    // Tolerances of spec §9 for Owen points.
    for (spp, tolerance) in [(1024, 1e-2), (4096, 3e-3), (65536, 5e-4)] {
        let golden = golden(file);
        assert_eq!(list(&golden["cases"]).len(), count);
        for case in list(&golden["cases"]) {
            let compare = |mode: NearRadiance| {
                let result = evaluate(case, spp, mode);
                let near = |expected: &Value| (result.near - vec3(expected)).abs().max_element();
                let error = match case["quantity"].as_str() {
                    Some("O") => (f64::from(result.openness) - number(&case["value"])).abs() as f32,
                    _ => near(&case["value"]),
                };
                assert!(error < tolerance, "{file} {} {mode:?} at {spp}: error {error}", case["id"]);
            };
            match case["quantity"].as_str() {
                Some("I_avg") => compare(NearRadiance::AveragedPlain),
                // With weights 1 - μ the average is the sum per hit (spec §3).
                _ => [NearRadiance::PerHit, NearRadiance::Averaged].into_iter().for_each(compare),
            }
        }
    }
}

#[test]
fn planes() {
    check("planes", 27);
}

#[test]
fn interiors() {
    check("interiors", 9);
}

#[test]
fn occluders() {
    check("occluders", 25);
}

#[test]
fn colour() {
    check("colour", 8);
}

#[test]
fn general() {
    check("general", 7);
}
