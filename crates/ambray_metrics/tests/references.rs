//! The measures agree with other implementations on stored pairs: scikit-image, NumPy and NVIDIA's FLIP, see
//! `pairs/make.py`.
#![forbid(unsafe_code)]

use std::{fs, path::PathBuf};

use ambray_metrics::{Map, Measure, Measures};
use serde_json::Value;

fn file(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/pairs").join(name)
}

/// The maps of a file, `channels` of them: single precision, little-endian, one after another.
fn maps(name: &str, width: usize, channels: usize) -> Vec<Map> {
    let bytes = fs::read(file(&format!("{name}.f32"))).unwrap_or_else(|error| panic!("{name}: {error}"));
    let values: Vec<f32> =
        bytes.chunks_exact(4).map(|v| f32::from_le_bytes(v.try_into().expect("four bytes"))).collect();
    values.chunks_exact(values.len() / channels).map(|v| Map { width, values: v.to_vec() }).collect()
}

/// How far a measure may be off, relative to its value; derived below.
fn tolerance(measure: Measure) -> f64 {
    match measure {
        // Both sum the same single-precision values in double precision, in other orders: some 10⁴ roundings of 1.1e-16.
        // The pattern is a quotient of powers, with an error that grows with the dynamic range of the spectrum.
        Measure::PatternLeft => 1e-9,
        // NVIDIA's code computes in single precision: 6e-8 times some 10² taps and powers of other C libraries.
        Measure::Flip => 1e-5,
        _ => 1e-11,
    }
}

#[track_caller]
fn check(name: &str) {
    let all: Vec<Value> =
        serde_json::from_slice(&fs::read(file("values.json")).expect("values")).expect("JSON");
    let pair = all.iter().find(|pair| pair["estimate"] == name).expect("a pair of this name");
    let number = |key: &str| pair[key].as_u64().expect("a number") as usize;
    let read = |key: &str| Some(maps(pair.get(key)?.as_str()?, number("width"), number("channels")));
    let [estimate, reference] = ["estimate", "reference"].map(|key| read(key).expect("maps"));
    let measures = match (&estimate[..], &reference[..], read("filtered-reference")) {
        ([estimate], [reference], Some(filtered)) => Measures::of_filtered(estimate, reference, &filtered[0]),
        ([estimate], [reference], None) => Measures::of(estimate, reference),
        _ => Measures::of_levels(&estimate, &reference).seen_as(&estimate, &reference),
    };
    let mut failures = Vec::new();
    for &measure in Measure::ALL {
        let expected = pair["measures"].get(measure.name()).and_then(Value::as_f64);
        let actual = measures.get(measure);
        println!("{name:9} {measure:14} {actual:?} {expected:?}");
        match (actual, expected) {
            (Some(actual), Some(expected))
                if (actual - expected).abs() <= tolerance(measure) * expected.abs().max(1e-3) => {}
            (None, None) => {}
            _ => failures.push(format!("{measure}: {actual:?} is not {expected:?}")),
        }
    }
    assert!(failures.is_empty(), "{name}: {}", failures.join("; "));
}

#[test]
fn noise_is_measured_as_others_do() {
    check("noise");
}

#[test]
fn a_change_of_brightness_is_measured_as_others_do() {
    check("shift");
}

#[test]
fn lost_detail_is_measured_as_others_do() {
    check("blur");
}

#[test]
fn what_the_filter_leaves_is_measured_as_others_do() {
    check("filtered");
}

#[test]
fn a_pattern_is_measured_as_others_do() {
    check("tiled");
}

#[test]
fn colours_are_measured_as_others_do() {
    check("tinted");
}
