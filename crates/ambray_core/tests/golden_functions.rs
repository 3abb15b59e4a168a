//! Single functions against golden values: frames, measures, ray offsets, shading, sampling (spec §§1, 2, 4, 5, 6).

mod common;

use ambray_core::{
    basis::Basis,
    compose::{compose, near_radiance},
    offset::RayOffset,
    sampling::{CLASS_TABLE, DEFAULT_SEEDS, PixelKey, SampleSets, owen, owen_point, sobol1},
    settings::{RadianceSource, Sampling, Sequence},
};
use common::{golden, integer, list, measure, number, vec3};
use glam::Vec3;

#[test]
fn frames_of_normals() {
    for case in list(&golden("functions")["onb"]) {
        let frame = Basis::from_normal(vec3(&case["n"]));
        assert!(frame.tangent.abs_diff_eq(vec3(&case["t"]), 1e-6), "{case}");
        assert!(frame.bitangent.abs_diff_eq(vec3(&case["b"]), 1e-6), "{case}");
    }
}

#[test]
fn fuzzy_measures() {
    let cases = golden("functions");
    for case in list(&cases["mu"]) {
        let mu = measure(&case["mu"]).0.at(number(&case["d"]) as f32);
        assert!((f64::from(mu) - number(&case["value"])).abs() < 1e-6, "{case}: {mu}");
    }
    assert_eq!(list(&cases["mu"]).len(), 36);
}

#[test]
fn ray_offsets_bit_for_bit() {
    for case in list(&golden("functions")["offset_float32"]) {
        let out = RayOffset::UNIT.apply(vec3(&case["p"]), vec3(&case["n"]), 0.0);
        let bits: Vec<u32> = list(&case["out_bits"]).iter().map(integer).collect();
        assert_eq!(out.to_array().map(f32::to_bits), bits[..], "{case}");
    }
}

#[test]
fn final_radiance() {
    for case in list(&golden("functions")["shade"]["cases"]) {
        let albedo = vec3(&case["albedo"]);
        let cos = number(&case["cos"]).max(0.0) * number(&case["visible"]);
        let direct = albedo * vec3(&case["light_irradiance"]) * (cos / std::f64::consts::PI) as f32;
        let openness = number(&case["openness"]) as f32;
        let radiance =
            compose(Vec3::ZERO, albedo, vec3(&case["ambient"]), openness, vec3(&case["near"]), direct);
        assert!(radiance.abs_diff_eq(vec3(&case["radiance"]), 1e-6), "{case}: {radiance}");
    }
}

#[test]
fn self_similar_bounce() {
    let ambient = Vec3::new(0.5, 1.0, 2.0);
    for case in list(&golden("functions")["self_similar_bounce"]["cases"]) {
        let openness = number(&case["openness"]) as f32;
        // What the gather returns for this source: the mean albedo of the near hits times 1 - O.
        let gathered = Vec3::splat(number(&case["near_albedo"]) as f32 * (1.0 - openness));
        let near = near_radiance(RadianceSource::SelfSimilar, ambient, openness, gathered);
        let radiance = compose(Vec3::ZERO, Vec3::ONE, ambient, openness, near, Vec3::ZERO);
        assert!(radiance.abs_diff_eq(ambient * number(&case["factor"]) as f32, 1e-6), "{case}: {radiance}");
    }
}

#[test]
fn sample_points_bit_for_bit() {
    let file = golden("sampling");
    let integers = |name: &str| list(&file[name]).iter().map(integer).collect::<Vec<u32>>();
    assert_eq!(DEFAULT_SEEDS, [integer(&file["seed0"]), integer(&file["seed1"])]);
    assert_eq!((0..16).map(u32::reverse_bits).collect::<Vec<_>>(), integers("bitrev_0_15"));
    assert_eq!((0..16).map(sobol1).collect::<Vec<_>>(), integers("sobol1_0_15"));
    assert_eq!((0..16).map(|i| owen(i, DEFAULT_SEEDS[0])).collect::<Vec<_>>(), integers("owen_of_i_seed0"));
    for (dim, name) in ["dim0", "dim1"].into_iter().enumerate() {
        let points: Vec<u32> = (0..128).map(|i| owen_point(i, DEFAULT_SEEDS)[dim]).collect();
        assert_eq!(points, integers(name), "{name}");
    }
    let table: Vec<Vec<u32>> =
        list(&file["class_table_rows_y"]).iter().map(|row| list(row).iter().map(integer).collect()).collect();
    assert_eq!(table, CLASS_TABLE.map(|row| row.map(u32::from).to_vec()));
}

#[test]
fn sample_directions() {
    let sets = SampleSets::new(Sampling::Interleaved, Sequence::Auto, 8, 0, 0);
    for (j, expected) in list(&golden("sampling")["hemisphere_polar_first8"]).iter().enumerate() {
        let direction = sets.direction(PixelKey { class: 0, hash: 0 }, j as u32);
        assert!(direction.local.abs_diff_eq(vec3(expected), 1e-6), "{j}: {}", direction.local);
    }
}
