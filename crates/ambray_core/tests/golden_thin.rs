//! Thin-object detection against golden values for given directions, and its neutrality (spec §8).

mod common;

use ambray_core::{
    gather::Gathered,
    sampling::SampleSets,
    settings::{NearRadiance, Sampling, Sequence, Thin},
};
use common::{gather_at, golden, integer, list, number};
use glam::{Vec2, Vec3};
use serde_json::{Value, json};

fn evaluate(case: &Value, samples: &SampleSets, thin: Thin, thin_edge: bool, near: NearRadiance) -> Gathered {
    gather_at(case, samples, |params| {
        (params.thin, params.thin_edge, params.near_radiance) = (thin, thin_edge, near)
    })
}

fn given(case: &Value) -> SampleSets {
    let points: Vec<Vec2> =
        list(&case["xi"]).iter().map(|xi| Vec2::new(number(&xi[0]) as f32, number(&xi[1]) as f32)).collect();
    SampleSets::from_points(&points)
}

#[test]
fn given_directions() {
    let file = golden("thin");
    for case in list(&file["cases"]) {
        let samples = given(case);
        let close = |value: f32, name: &str| {
            assert!((f64::from(value) - number(&case[name])).abs() < 1e-4, "{} {name}: {value}", case["id"]);
        };
        let count = |name: &str| integer(&case[name]);
        // With and without radiance: closest-hit and any-hit chords must agree.
        for near in [NearRadiance::Off, NearRadiance::Averaged] {
            let paper = evaluate(case, &samples, Thin::Paper, false, near);
            close(paper.first, "openness_first");
            close(paper.second, "paper_A2");
            close(paper.openness, "paper_openness");
            assert_eq!(
                (paper.chord_rays, paper.chord_hits),
                (count("pairs"), count("pairs_blocked")),
                "{}",
                case["id"]
            );
            assert_eq!(paper.ambient_rays - paper.ambient_hits, count("misses"));

            let sheet = evaluate(case, &samples, Thin::Sheet, false, near);
            close(sheet.second, "opposite_A2");
            close(sheet.openness, "opposite_openness");
            assert_eq!(sheet.chord_rays, count("opposite_pairs"), "{}", case["id"]);
            close(evaluate(case, &samples, Thin::Sheet, true, near).openness, "opposite_edge_openness");
        }
    }
    assert_eq!(list(&file["cases"]).len(), 11);
}

/// Convex free space is never changed: bit-equal to off (spec §8.3).
#[test]
fn neutral_where_free_space_is_convex() {
    let wall = |x: f32| json!({"type": "plane", "point": [x, 0, 0], "normal": [1, 0, 0]});
    let ceiling = json!({"type": "plane", "point": [0, 0.6, 0], "normal": [0, 1, 0]});
    let corner = json!({"type": "plane", "point": [0, 0, -0.2], "normal": [0, 0, 1]});
    let scenes = [
        json!([]),
        json!([wall(-0.1)]),
        json!([wall(-0.1), corner]),
        json!([wall(-0.4), wall(0.5), corner, ceiling]),
    ];
    for geometry in scenes {
        let case = json!({"geometry": geometry, "point": [0.0, 0.0, 0.0], "normal": [0, 1, 0],
            "mu": {"kind": "poly", "alpha": 1.0, "R": 1.0}});
        for seed in 0..200 {
            let samples = SampleSets::new(Sampling::Same, Sequence::Owen, 8, 0, seed);
            let off = evaluate(&case, &samples, Thin::Off, false, NearRadiance::Averaged);
            for (thin, edge) in [(Thin::Paper, false), (Thin::Sheet, false), (Thin::Sheet, true)] {
                let on = evaluate(&case, &samples, thin, edge, NearRadiance::Averaged);
                assert_eq!((on.openness, on.near), (off.openness, off.near), "{thin:?} changes {case}");
            }
        }
    }
}

/// A red sheet that only chords find still bleeds its colour, by 1 - O times its radiance (spec §8.1).
#[test]
fn chords_bring_their_colour() {
    let mut case = list(&golden("thin")["cases"])[1].clone();
    case["geometry"][0]["radiance"] = json!([0.8, 0.1, 0.05]);
    let samples = given(&case);
    for thin in [Thin::Paper, Thin::Sheet] {
        for near in [NearRadiance::Averaged, NearRadiance::AveragedPlain, NearRadiance::PerHit] {
            let lit = evaluate(&case, &samples, thin, false, near);
            let expected = Vec3::new(0.8, 0.1, 0.05) * (1.0 - lit.openness);
            assert!(lit.first == 1.0 && lit.openness < 0.9, "{thin:?} {near:?}: {lit:?}");
            assert!(lit.near.abs_diff_eq(expected, 1e-6), "{thin:?} {near:?}: {} for {expected}", lit.near);
        }
    }
}

/// Where the first batch hits something, the darkening by the second keeps the colour of the near field.
#[test]
fn darkening_keeps_the_colour() {
    let mut case = list(&golden("thin")["cases"])[2].clone();
    case["geometry"][0]["radiance"] = json!([0.8, 0.1, 0.05]);
    let lit = evaluate(&case, &given(&case), Thin::Paper, false, NearRadiance::PerHit);
    assert!(lit.openness < lit.first && lit.first < 1.0);
    let expected = lit.near_first * ((1.0 - lit.openness) / (1.0 - lit.first));
    assert!(lit.near.abs_diff_eq(expected, 1e-6), "{} for {expected}", lit.near);
}
