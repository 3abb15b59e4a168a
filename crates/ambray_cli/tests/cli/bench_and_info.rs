//! `ambray bench` and `ambray info`.

use super::Bench;

fn json(bytes: &[u8]) -> serde_json::Value {
    serde_json::from_slice(bytes).expect("JSON")
}

#[test]
fn bench_measures_frames() {
    let bench = Bench::new();
    let measure = ["bench", "scene.obj", "--size=64x36", "--frames=7", "--warmup=1"];
    let run = bench.run(&[&measure[..], &["--json", "-o", "bench.json"]].concat()).succeeds();
    let report = json(&run.stdout);
    assert_eq!(report, json(&bench.read("bench.json")));
    let scene = &report["scenes"][0];
    assert_eq!(scene["frames"], 7);
    let time = |name: &str| scene["frame_ms"][name].as_f64().expect("a number");
    assert!(0.0 < time("min") && time("min") <= time("median") && time("median") <= time("p95"));
    assert!(scene["rays"]["mrays_per_s"].as_f64().is_some_and(|rate| rate > 0.0));
    assert!(scene["stages"]["primary_ms"].is_number());
    assert!(report["machine"]["isa"].is_string() && report["machine"]["cores"].is_number());
    assert_eq!(report["settings"]["size"], "64x36");

    let text = bench.run(&measure).succeeds().text();
    assert!(text.contains("frames   7: median"), "{text}");
    let both =
        bench.run(&["bench", "scene.obj", "scene.obj", "--size=8x8", "--frames=1", "--json"]).succeeds();
    assert_eq!(json(&both.stdout)["scenes"].as_array().map(Vec::len), Some(2));
}

#[test]
fn thin_detection_is_measured_beside_a_frame_without() {
    let bench = Bench::new();
    let measure = ["bench", "scene.obj", "--size=64x36", "--frames=1", "--warmup=0", "--thin-cost"];
    let report = json(&bench.run(&[&measure[..], &["--json"]].concat()).succeeds().stdout);
    let scene = &report["scenes"][0];
    let costs = scene["thin_cost"].as_array().expect("a list");
    let names: Vec<_> = costs.iter().map(|cost| cost["thin"].as_str().expect("a name")).collect();
    assert_eq!(names, ["off", "paper", "sheet"]);
    assert_eq!(costs[0]["more_ms"], 0.0);
    assert_eq!(costs[0]["rays"]["chord"], 0);
    assert!(costs[1]["rays"]["chord"].as_u64() > costs[2]["rays"]["chord"].as_u64());
    assert_eq!(report["settings"]["spp"], 8);
    assert_eq!(report["settings"]["thin"], "off");
    assert_eq!(costs[0]["rays_per_pixel"], scene["cost"]["rays_per_pixel"]["total"]);
    let text = bench.run(&measure).succeeds().text();
    assert!(text.contains("more ms") && text.contains("  sheet "), "{text}");
    bench.run(&["bench", "--thin-cost", "--thin=off"]).fails(&["--thin is not allowed with --thin-cost"]);
}

#[test]
fn the_cost_of_a_frame_is_told() {
    let bench = Bench::new();
    let measure = ["bench", "scene.obj", "--size=64x36", "--frames=1", "--warmup=0"];
    let report = json(&bench.run(&[&measure[..], &["--json"]].concat()).succeeds().stdout);
    let cost = &report["scenes"][0]["cost"];
    assert_eq!(cost["pixels"], 64 * 36);
    assert_eq!(cost["rays_per_pixel"]["primary"], 1.0);
    assert_eq!(cost["passes"], serde_json::json!([]), "the processor has no passes over planes");
    let text = bench.run(&[&measure[..], &["--cost"]].concat()).succeeds().text();
    assert!(text.contains("cost     ") && text.contains("rays a pixel: primary 1.00"), "{text}");
    bench.run(&["bench", "--bandwidth=0"]).fails(&["--bandwidth 0 is not allowed: gigabytes a second"]);
}

#[test]
fn info_tells_what_is_in_a_scene() {
    let bench = Bench::new();
    let text = bench.run(&["info", "scene.obj"]).succeeds().text();
    for part in ["4 triangles", "bounds   -2,0,-2 to 2,4,2", "radius", "meshes", "cameras"] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
    let info = json(&bench.run(&["info", "scene.obj", "--json"]).succeeds().stdout);
    assert_eq!(info["scene"]["triangles"], 4);
    assert_eq!(info["bounds"]["high"], serde_json::json!([2.0, 4.0, 2.0]));
    assert!(info["default_view"]["radius"].is_number());
    assert_eq!(info["materials"][0]["alpha_mode"], "opaque");
}

#[test]
fn info_alone_tells_about_the_program() {
    let bench = Bench::new();
    let text = bench.run(&["info"]).succeeds().text();
    assert!(text.contains("ambray ") && text.contains("threads"), "{text}");
    let info = json(&bench.run(&["info", "--json"]).succeeds().stdout);
    assert_eq!(info["version"], env!("CARGO_PKG_VERSION"));
}

#[test]
fn built_in_scene_needs_no_file() {
    let bench = Bench::new();
    let info = json(&bench.run(&["info", "atrium", "--json"]).succeeds().stdout);
    assert_eq!(info["scene"]["source"], "atrium");
    assert!(info["scene"]["triangles"].as_u64().is_some_and(|count| count > 0));
    bench.run(&["render", "--size=64x36", "--spp=1", "-q"]).succeeds();
    assert_eq!(bench.files(), ["ambray.png"]);
}
