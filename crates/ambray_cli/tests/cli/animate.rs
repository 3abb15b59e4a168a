//! `ambray bench --animate`, `--updates`, and what `ambray info` says about movement.

use super::Bench;

fn json(bytes: &[u8]) -> serde_json::Value {
    serde_json::from_slice(bytes).expect("JSON")
}

const MEASURE: [&str; 5] = ["bench", "moving.gltf", "--animate", "--size=32x18", "--repeats=1"];

#[test]
fn every_way_of_updating_plays_the_same_poses() {
    let bench = Bench::animated();
    let line = [&MEASURE[..], &["--animation=Bend", "--fps=20", "--json", "-o", "bench.json"]].concat();
    let report = json(&bench.run(&line).succeeds().stdout);
    assert_eq!(report, json(&bench.read("bench.json")));
    let scene = &report["scenes"][0];
    assert_eq!((&scene["animation"], &scene["poses"]), (&"1 (Bend)".into(), &10.into()));
    let policies = scene["policies"].as_array().expect("a list");
    let names: Vec<_> = policies.iter().map(|p| p["updates"].as_str().expect("a name")).collect();
    assert_eq!(names, ["auto", "refit", "rebuild", "cache"]);
    for policy in policies {
        for stage in ["deformation", "bottom_level", "top_level", "trace", "filter", "frame"] {
            let spread = &policy[format!("{stage}_ms")];
            let of = |name: &str| spread[name].as_f64().expect("a number");
            assert!(of("min") <= of("median") && of("median") <= of("p95"), "{stage}: {spread}");
        }
        let frames = policy["frames"].as_array().expect("poses");
        assert_eq!(frames.len(), 10);
        assert_eq!(frames[3]["time"], 0.15);
        assert!(policy["slowdown"]["worst"].as_f64() >= policy["slowdown"]["median"].as_f64());
        assert!(policy["decay"].as_f64().is_some_and(|decay| decay >= 1.0));
    }
    assert_eq!(policies[2]["slowdown"]["worst"], 1.0);
    let counts = |name: &str| [&policies[1][name], &policies[2][name]].map(serde_json::Value::as_u64);
    assert_eq!(counts("refitted"), [Some(10), Some(0)]);
    assert_eq!(counts("rebuilt"), [Some(0), Some(10)]);
}

#[test]
fn one_way_may_be_chosen_and_poses_limited() {
    let bench = Bench::animated();
    let line = [&MEASURE[..], &["--updates=refit", "--frames=3"]].concat();
    let text = bench.run(&line).succeeds().text();
    assert!(text.contains("animation 0 (Slide), 2.00 s: 3 poses at 30 fps, 32x18"), "{text}");
    let rows: Vec<_> = text.lines().filter(|line| line.starts_with("  ")).map(str::trim).collect();
    assert!(rows[0].starts_with("refit") && !text.contains("rebuild  "), "{text}");
    let report = json(&bench.run(&[&line[..], &["--json"]].concat()).succeeds().stdout);
    assert_eq!(report["scenes"][0]["policies"][0]["slowdown"], serde_json::Value::Null);
    assert_eq!(report["scenes"][0]["policies"][0]["rebuilt"], 0);
}

#[test]
fn what_cannot_be_played_is_told() {
    let bench = Bench::animated();
    bench.run(&["bench", "--animate", "scene.obj"]).fails(&["scene.obj has no animation", "banner"]);
    bench.run(&[&MEASURE[..], &["--animation=Run"]].concat()).fails(&["it has 0 (Slide), 1 (Bend)"]);
    bench.run(&[&MEASURE[..], &["--cost"]].concat()).fails(&["--cost is not allowed with --animate"]);
    bench.run(&["bench", "--fps=30"]).fails(&["--fps is not allowed without --animate"]);
    bench.run(&["bench", "--updates=never"]).fails(&["--updates never is not allowed: auto, refit"]);
}

#[test]
fn pictures_do_not_depend_on_updates() {
    let bench = Bench::animated();
    let pictures: Vec<_> = ["auto", "refit", "rebuild", "cache"]
        .map(|updates| {
            let line = ["--animation=Bend", "--frames=0..4", "--fps=8", "-o", "#.png"];
            bench.animate(&[&line[..], &[&format!("--updates={updates}")]].concat()).succeeds();
            ["0.png", "1.png", "2.png", "3.png"].map(|name| bench.read(name))
        })
        .into();
    assert!(pictures.iter().all(|frames| *frames == pictures[0]));
}

#[test]
fn info_tells_what_moves() {
    let bench = Bench::animated();
    let text = bench.run(&["info", "moving.gltf"]).succeeds().text();
    for part in [
        "animated 2 animations",
        "0 Slide: 2.00 s, translation of 1 node",
        "1 Bend: 0.50 s, weights of 1 node",
        "deforms  1 mesh, 0 skins",
        "lid: 6 vertices, 1 morph target",
        "moves    0 instances as a whole, 1 deforming",
    ] {
        assert!(text.contains(part), "{part} is missing in\n{text}");
    }
    let info = json(&bench.run(&["info", "moving.gltf", "--json"]).succeeds().stdout);
    assert_eq!(
        (&info["animations"][1]["name"], &info["animations"][1]["duration_s"]),
        (&"Bend".into(), &0.5.into())
    );
    assert_eq!(info["deforming_meshes"][0]["morph_targets"], 1);
    assert_eq!(info["deforming_instances"], 1);
    let still = json(&bench.run(&["info", "scene.obj", "--json"]).succeeds().stdout);
    assert_eq!(still["animations"], serde_json::json!([]));
    assert!(!bench.run(&["info", "scene.obj"]).succeeds().text().contains("animat"));
}

#[test]
fn built_in_scenes_move() {
    let bench = Bench::new();
    for name in ["banner", "flock"] {
        let info = json(&bench.run(&["info", name, "--json"]).succeeds().stdout);
        assert_eq!(info["scene"]["source"], name);
        assert_eq!(info["animations"].as_array().map(Vec::len), Some(1), "{name}");
    }
    bench.run(&["render", "banner", "--size=64x36", "--spp=1", "-q", "--time=1"]).succeeds();
    assert_eq!(bench.files(), ["ambray.png"]);
}
