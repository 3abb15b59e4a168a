//! `ambray diff`: what two pictures have in common.

use std::fs;

use serde_json::Value;

use super::{Bench, Png, Run, outputs::channels};

/// A PNG file of grey, `width` pixels in a row.
fn grey(width: u32, values: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, width, values.len() as u32 / width);
    encoder.set_color(png::ColorType::Grayscale);
    let mut writer = encoder.write_header().expect("a head");
    writer.write_image_data(values).expect("pixels");
    writer.finish().expect("an end");
    bytes
}

/// A bench with `a.png` of 51s and `b.png` like it but for one pixel of 102 at column 3, row 1.
fn with_pair() -> Bench {
    let bench = Bench::new();
    let mut values = [51; 16 * 12];
    fs::write(bench.path("a.png"), grey(16, &values)).expect("picture");
    values[16 + 3] = 102;
    fs::write(bench.path("b.png"), grey(16, &values)).expect("picture");
    bench
}

impl Run {
    /// Ends with 1, since something is over the tolerance.
    #[track_caller]
    fn differs(self, part: &str) -> Self {
        assert_eq!(self.code, Some(1), "ambray {}: {}", self.arguments, self.stderr);
        assert!(self.stderr.contains(part), "ambray {} lacks {part:?} in:\n{}", self.arguments, self.stderr);
        self
    }

    fn json(&self) -> Value {
        serde_json::from_slice(&self.stdout).expect("JSON")
    }
}

#[test]
fn a_picture_agrees_with_itself() {
    let bench = Bench::new();
    bench.render(&["-o", "all.exr", "--aov=all"]).succeeds();
    let report = bench.run(&["diff", "all.exr", "all.exr", "--json"]).succeeds().json();
    assert_eq!((&report["is_within"], &report["settings"]), (&true.into(), &Value::Array(Vec::new())));
    let layers = report["layers"].as_array().expect("layers");
    assert_eq!(layers.len(), ambray::Aov::ALL.len());
    for layer in layers {
        assert_eq!((&layer["differing"], &layer["not_finite"]), (&0.into(), &0.into()), "{layer}");
        assert_eq!((&layer["measures"]["rmse"], &layer["largest_at"]), (&0.0.into(), &Value::Null));
    }
    assert_eq!(layers[0]["name"], "beauty");
    assert_eq!(layers[0]["measures"]["psnr"], Value::Null, "infinite");
    let depth = layers.iter().find(|layer| layer["name"] == "depth").expect("depth");
    assert_eq!((depth["measures"].get("psnr"), depth["measures"].get("flip")), (None, None));

    for format in ["png8", "png16"] {
        bench.render(&["-o", "a.png", "--format", format]).succeeds();
        let run = bench.run(&["diff", "a.png", "a.png"]).succeeds();
        assert!(run.text().contains("picture") && run.stderr.is_empty(), "{run:?}");
    }
}

#[test]
fn the_table_says_what_differs_and_where() {
    let bench = with_pair();
    let run =
        bench.run(&["diff", "a.png", "b.png"]).differs("picture: rmse 0.01443 is over the tolerance of 0");
    // One of 192 pixels is (51 − 102)/255 = −0.2 off: RMSE 0.2/√192 = 0.01443, PSNR 20 log₁₀(√192/0.2) = 36.81, bias
    // −0.2/192. Sorted, 99 % is pixel 189.09 of 0 to 191, where there is no error. The step of 0.2 makes five edges, of
    // which one is wrong: 0.2/√5. FLIP and SSIM are proven with the metrics.
    let text = run.text();
    let row: Vec<&str> = text.lines().last().expect("a row").split_whitespace().collect();
    let expected = ["picture", "0.52", "%", "0.01443", "36.81", "-0.00104", "0", "0.2000"];
    assert_eq!(row[..8], expected, "{text}");
    assert_eq!(row[10..], ["0.08944", "0", "3,1"], "{text}");
    let heading = text.lines().nth(2).expect("a heading").split_whitespace().collect::<Vec<_>>().join(" ");
    let titles = "layer differ RMSE PSNR (dB) bias p99 max FLIP SSIM edge RMSE flat RMSE max at";
    assert_eq!(heading, titles, "{text}");
    assert!(text.starts_with("a.png against b.png: 16 x 12 pixels, 1 layer\n"), "{text}");
}

#[test]
fn numbers_are_those_of_the_values_in_the_files() {
    let bench = Bench::new();
    bench.render(&["-o", "a.exr", "--aov=openness,depth", "--spp=2"]).succeeds();
    bench.render(&["-o", "b.exr", "--aov=openness,depth", "--spp=16"]).succeeds();
    let run = bench.run(&["diff", "a.exr", "b.exr", "--json"]).differs("rmse");
    let report = run.json();
    let [a, b] = ["a.exr", "b.exr"].map(|name| channels(&bench, name));
    let values = |file: &[(String, Vec<f32>)], name: &str| {
        file.iter().find(|(channel, _)| channel == name).expect("a channel").1.clone()
    };
    let error: Vec<f64> = values(&a, "openness.Y")
        .iter()
        .zip(values(&b, "openness.Y"))
        .map(|(a, b)| f64::from(*a) - f64::from(b))
        .collect();
    let mean = |f: &dyn Fn(f64) -> f64| error.iter().map(|&e| f(e)).sum::<f64>() / error.len() as f64;
    let layer = report["layers"].as_array().expect("layers").iter().find(|l| l["name"] == "openness");
    let measures = &layer.expect("openness")["measures"];
    let is_near = |name: &str, expected: f64| {
        let actual = measures[name].as_f64().expect("a number");
        assert!((actual - expected).abs() <= 1e-12, "{name}: {actual} is not {expected}");
    };
    assert!(mean(&|e| e * e) > 0.0);
    is_near("rmse", mean(&|e| e * e).sqrt());
    is_near("bias", mean(&|e| e));
    is_near("max", error.iter().fold(0.0, |most, e| most.max(e.abs())));
    // The same surfaces are seen, and the sky at the same places: infinities agree.
    let depth = report["layers"].as_array().expect("layers").iter().find(|l| l["name"] == "depth");
    assert_eq!(
        (&depth.expect("depth")["differing"], &depth.expect("depth")["not_finite"]),
        (&0.into(), &0.into())
    );
    assert!(values(&a, "depth.Z").iter().any(|depth| depth.is_infinite()));
    let settings = serde_json::json!([{"name": "spp", "picture": "2", "reference": "16"}]);
    assert_eq!(report["settings"], settings);
    let text = bench.run(&["diff", "a.exr", "b.exr"]).differs("beauty: rmse").text();
    assert!(text.ends_with("settings differ:\n  spp 2 against 16\n"), "{text}");
}

#[test]
fn the_tolerance_decides_by_the_measure_that_was_chosen() {
    let bench = with_pair();
    let diff = |more: &[&str]| bench.run(&[&["diff", "a.png", "b.png", "--quiet"], more].concat());
    for within in [
        &["--tolerance=0.0145"][..],
        &["--measure=max", "--tolerance=0.21"],
        &["--measure=p99"],
        &["--measure=flat-rmse"],
        &["--measure=bias", "--tolerance=0.002"],
        &["--measure=psnr", "--tolerance=36.8"],
        &["--measure=ssim", "--tolerance", "-1"],
    ] {
        let run = diff(within).succeeds();
        assert_eq!((run.text().as_str(), run.stderr.as_str()), ("", ""));
    }
    for over in [
        &["--tolerance=0.0144"][..],
        &["--measure=max", "--tolerance=0.19"],
        &["--measure=bias"],
        &["--measure=flip"],
        &["--measure=psnr", "--tolerance=36.9"],
        &["--measure=ssim", "--tolerance=1"],
    ] {
        let run = diff(over).differs("");
        assert_eq!((run.text().as_str(), run.stderr.as_str()), ("", ""));
    }
    diff(&["--measure=psnr"]).fails(&["--measure psnr needs a --tolerance", "hint"]);
    diff(&["--tolerance=-1"]).fails(&["--tolerance -1 is not allowed"]);
    diff(&["--tolerance=inf"]).fails(&["--tolerance inf is not allowed: a number"]);
    diff(&["--measure=mse"]).fails(&["--measure mse is not allowed", "rmse", "flip"]);
    diff(&["--measure=grain"]).fails(&["--measure grain is not allowed"]);
}

#[test]
fn pictures_that_cannot_be_compared_say_why() {
    let bench = with_pair();
    fs::write(bench.path("small.png"), grey(4, &[0; 16])).expect("picture");
    bench.render(&["-o", "few.exr", "--aov=depth"]).succeeds();
    bench.render(&["-o", "more.exr", "--aov=openness,depth"]).succeeds();
    bench.render(&["-o", "color.png"]).succeeds();
    bench
        .run(&["diff", "a.png", "small.png"])
        .fails(&["the sizes differ: a.png has 16x12 pixels, small.png has 4x4"]);
    bench
        .run(&["diff", "few.exr", "more.exr"])
        .fails(&["few.exr has no layer openness: it has beauty, depth", "hint: --common"]);
    bench.run(&["diff", "few.exr", "more.exr", "--common"]).succeeds();
    bench.run(&["diff", "more.exr", "few.exr", "--layer=depth"]).succeeds();
    bench
        .run(&["diff", "more.exr", "few.exr", "--layer=depths"])
        .fails(&["more.exr has no layer depths: it has"]);
    bench.run(&["diff", "few.exr", "color.png"]).fails(&["color.png has no layer beauty: it has picture"]);
    bench
        .run(&["diff", "few.exr", "more.exr", "--common", "--measure=flip"])
        .fails(&["--measure flip does not apply to layer depth"]);
    bench.run(&["diff", "a.png", "none.png"]).fails(&["picture none.png: "]);
    bench.run(&["diff", "a.png", "scene.obj"]).fails(&["picture scene.obj: is neither PNG nor OpenEXR"]);
    bench.run(&["diff", "a.png"]).fails(&["REFERENCE"]);
    bench.run(&["diff", "a.png", "b.png", "--signed"]).fails(&["--signed is not allowed without --output"]);
    bench.run(&["diff", "a.png", "b.png", "-o", "e.jpg"]).fails(&["e.jpg", "PNG"]);
    bench.run(&["diff", "a.png", "b.png", "-o", "no/e.png"]).fails(&["the folder no does not exist"]);
    bench.run(&["diff", "a.png", "b.png", "-o-"]).fails(&["-o -"]);
    bench.run(&["diff", "a.png", "b.png", "-oe.png", "--range=1,0"]).fails(&["--range 1,0 is not allowed"]);
}

#[test]
fn edges_that_are_not_there_are_not_wrong() {
    let bench = with_pair();
    // The reference a.png is flat: no neighbours differ, so no pixel is at an edge; away from edges the error is 0.2/√192.
    let by = |measure: &str| bench.run(&["diff", "b.png", "a.png", "--quiet", "--measure", measure]);
    by("edge-rmse").succeeds();
    by("flat-rmse").differs("");
    let report = bench.run(&["diff", "a.png", "a.png", "--measure=edge-rmse", "--json"]).succeeds().json();
    assert_eq!(report["is_within"], Value::Bool(true));
    assert_eq!(report["layers"][0]["measures"].get("edge-rmse"), None, "there is nothing to measure");
    // In a chequered reference every pixel is at an edge, and none is flat.
    let chequered: Vec<u8> = (0..16 * 12).map(|i| if (i % 16 + i / 16) % 2 == 0 { 0 } else { 255 }).collect();
    fs::write(bench.path("chequered.png"), grey(16, &chequered)).expect("picture");
    let by = |measure: &str| bench.run(&["diff", "a.png", "chequered.png", "--quiet", "--measure", measure]);
    by("flat-rmse").succeeds();
    by("edge-rmse").differs("");
}

#[test]
fn a_picture_too_small_for_ssim_is_no_agreement() {
    let bench = Bench::new();
    for (name, height) in [("small.png", 10), ("large.png", 11)] {
        fs::write(bench.path(name), grey(16, &vec![51; 16 * height])).expect("picture");
    }
    let by = |name: &str| bench.run(&["diff", name, name, "--measure=ssim", "--tolerance=0.9"]);
    by("small.png").fails(&["--measure ssim needs at least 11x11 pixels", "hint: rmse"]);
    by("large.png").succeeds();
}

#[test]
fn errors_become_a_picture() {
    let bench = with_pair();
    let picture = |more: &[&str]| {
        bench.run(&[&["diff", "a.png", "b.png", "-q", "-o", "error.png"], more].concat()).differs("");
        let png = Png::of(&bench.read("error.png"));
        assert_eq!((png.size, png.color), ((16, 12), png::ColorType::Rgb));
        (png.bytes[..3].to_vec(), png.bytes[3 * (16 + 3)..][..3].to_vec())
    };
    // The ends of matplotlib's magma: no error, and the largest.
    assert_eq!(picture(&[]), (vec![0x00, 0x00, 0x04], vec![0xFC, 0xFD, 0xBF]));
    assert_eq!(picture(&["--ramp=grey", "--range=0,0.4"]), (vec![0; 3], vec![128; 3]));
    // The picture is below the reference: blue, and half of it with twice the range.
    assert_eq!(picture(&["--signed"]), (vec![255; 3], vec![0, 0, 255]));
    assert_eq!(picture(&["--signed", "--range=-0.4,0.4"]), (vec![255; 3], vec![128, 128, 255]));

    bench.render(&["-o", "x.exr", "--aov=openness,depth", "--spp=2"]).succeeds();
    bench.render(&["-o", "y.exr", "--aov=openness,depth", "--spp=3"]).succeeds();
    let run = bench.run(&["diff", "x.exr", "y.exr", "-o", "e.png", "--json"]).differs("(and 1 more)");
    assert_eq!(run.json()["outputs"], serde_json::json!(["e.png", "e.depth.png", "e.openness.png"]));
    assert_eq!(Png::of(&bench.read("e.openness.png")).size, (64, 36));
    let piped = bench.run(&["diff", "a.png", "b.png", "-q", "-o-"]).differs("");
    assert_eq!(Png::of(&piped.stdout).size, (16, 12));
}

#[test]
fn what_is_infinite_on_one_side_alone_is_over_every_tolerance() {
    let bench = Bench::new();
    let view = |target: &str, name: &str| {
        let target = format!("--camera-target={target}");
        let camera = ["--camera-position=0,1,3", target.as_str(), "--aov=depth", "-o", name];
        bench.render(&camera).succeeds();
    };
    view("0,1,0", "a.exr");
    view("0,1.5,0", "b.exr");
    let diff = ["diff", "a.exr", "b.exr", "--layer=depth", "--tolerance=1000000", "--json"];
    let report = bench.run(&diff).differs("infinite or not a number on one side").json();
    assert!(report["layers"][0]["not_finite"].as_u64().expect("a count") > 0);
    assert!(report["layers"][0]["measures"]["rmse"].as_f64().expect("a finite number").is_finite());
}

#[test]
fn forged_pictures_end_in_one_line() {
    let bench = with_pair();
    bench.render(&["-o", "x.exr"]).succeeds();
    let mut forged = bench.read("x.exr");
    let name = b"dataWindow\0box2i\0\x10\0\0\0";
    let at =
        forged.windows(name.len()).position(|window| window == name).expect("a data window") + name.len();
    for (i, corner) in [0, 0, 1_000_000, 1_000_000_i32].into_iter().enumerate() {
        forged[at + 4 * i..][..4].copy_from_slice(&corner.to_le_bytes());
    }
    fs::write(bench.path("forged.exr"), forged).expect("file");
    let run =
        bench.run(&["diff", "forged.exr", "x.exr"]).fails(&["picture forged.exr: claims 1000001x1000001"]);
    assert_eq!(run.stderr.lines().count(), 1);
    let whole = bench.read("a.png");
    fs::write(bench.path("cut.png"), &whole[..whole.len() - 20]).expect("file");
    bench.run(&["diff", "cut.png", "a.png"]).fails(&["picture cut.png: "]);
}
