//! Moments and sequences of animated scenes.

use std::{fs, time::Duration};

use super::{Bench, Png};

/// The middle of the sequence of the tests, by itself.
const MOMENT: [&str; 3] = ["--time=0.2", "-o", "moment.png"];

#[test]
fn a_moment_is_shown_and_its_picture_repeats_it() {
    let bench = Bench::animated();
    bench.animate(&["-o", "rest.png"]).succeeds();
    bench.animate(&["--time=1", "-o", "slid.png"]).succeeds();
    bench.animate(&["--time=0.25", "--animation=Bend", "-o", "bent.png"]).succeeds();
    bench.animate(&["--time=0.25", "--animation=all", "-o", "both.png"]).succeeds();
    let pixels = |name: &str| Png::of(&bench.read(name)).bytes;
    let names = ["rest.png", "slid.png", "bent.png", "both.png"];
    for (i, a) in names.iter().enumerate() {
        for b in &names[..i] {
            assert_ne!(pixels(a), pixels(b), "{a} and {b}");
        }
    }
    // By number; over the end; with the last pose; repeated from the picture.
    bench.animate(&["--time=0.25", "--animation=1", "-o", "a.png"]).succeeds();
    assert_eq!(pixels("a.png"), pixels("bent.png"));
    bench.animate(&["--time=0.75", "--animation=Bend", "-o", "a.png"]).succeeds();
    assert_eq!(pixels("a.png"), pixels("bent.png"));
    bench.animate(&["--time=9", "--animation-loop=false", "-o", "a.png"]).succeeds();
    assert_eq!(pixels("a.png"), pixels("rest.png"));
    bench.run(&["render", "moving.gltf", "-q", "--settings=bent.png", "-o", "a.png"]).succeeds();
    assert_eq!(bench.read("a.png"), bench.read("bent.png"));
}

#[test]
fn animations_that_are_not_there_are_told() {
    let bench = Bench::animated();
    bench
        .animate(&["--animation=Run"])
        .fails(&["--animation Run is not in the scene: it has 0 (Slide), 1 (Bend)"]);
    bench.animate(&["--animation=2"]).fails(&["--animation 2 is not in the scene"]);
    bench.animate(&["--time=-1"]).fails(&["--time -1 is not allowed: auto or 0 to 10000 seconds"]);
    bench.render(&["--time=1"]).fails(&["--time 1 is not allowed: scene.obj has no animation"]);
    bench.render(&["--animation=Run"]).fails(&["--animation Run is not allowed: scene.obj has no animation"]);
    bench.render(&["--frames=0..2", "-o", "#.png"]).fails(&["scene.obj has no animation", "--temporal on"]);
    assert_eq!(bench.made(), [""; 0]);
}

#[test]
fn frames_are_moments() {
    let bench = Bench::animated();
    bench.animate(&["--frames=1..4", "--fps=10", "-o", "out/f_##.png", "--aov=depth"]).succeeds();
    let expected: Vec<_> = ["01", "02", "03"]
        .iter()
        .flat_map(|n| [format!("out/f_{n}.depth.png"), format!("out/f_{n}.png")])
        .collect();
    assert_eq!(bench.made(), expected);
    bench.animate(&[&MOMENT[..], &["--aov=depth"]].concat()).succeeds();
    assert_eq!(bench.read("out/f_02.png"), bench.read("moment.png"));
    assert_eq!(bench.read("out/f_02.depth.png"), bench.read("moment.depth.png"));
    // A sequence may begin later: 0.1 + 1/10.
    bench.animate(&["--frames=1", "--fps=10", "--time=0.1", "-o", "one.png"]).succeeds();
    assert_eq!(bench.read("one.png"), bench.read("moment.png"));
    // Fractions, and every second frame: 2 · 3/30.
    bench.animate(&["--frames=0..=2:2", "--fps=30/3", "-o", "out/third_#.png"]).succeeds();
    assert_eq!(bench.read("out/third_2.png"), bench.read("moment.png"));
    assert!(!bench.made().contains(&"out/third_1.png".to_owned()));
    bench.animate(&["--frames=0..2", "--fps=10", "-o", "##.exr", "--aov=openness"]).succeeds();
    assert!(bench.path("01.exr").exists());
}

#[test]
fn names_of_frames_are_checked_before_the_work() {
    let bench = Bench::animated();
    let refused = |arguments: &[&str], parts: &[&str]| {
        let slow = ["--size=4096x4096", "--spp=65536"];
        bench.animate(&[&slow[..], arguments].concat()).fails(parts);
    };
    refused(&["--frames=0..3", "-o", "f.png"], &["3 frames need a name each", "hint:", "-o f_####.png"]);
    refused(&["--frames=0..3", "-o", "#_#.png"], &["# stands in two places"]);
    refused(&["--frames=0..3", "-o", "a/b/#.png"], &["the folder a does not exist"]);
    refused(&["--frames=0..3", "-o", "#.jpg"], &["allowed are"]);
    refused(&["--frames=0..3", "-o", "-"], &["-o - is not allowed with --frames", "--time"]);
    refused(&["--frames=0..3", "-o", "."], &["is a folder", "ambray_####.png"]);
    refused(&["--frames=3..3"], &["--frames 3..3 is not allowed: there is no frame in it"]);
    refused(&["--frames=0-3"], &["--frames 0-3 is not allowed: A..B"]);
    refused(&["--frames=0..3", "--fps=0"], &["--fps 0 is not allowed: frames a second"]);
    refused(
        &["--frames=0..2000", "--fps=0.01", "-o", "#.png"],
        &["the last frame has time", "10000 seconds"],
    );
    refused(&["--frames=0..3:2", "--temporal=on"], &["--temporal on, which needs every frame"]);
    refused(&["--fps=25"], &["--fps is not allowed without --frames"]);
    refused(&["--hold-time"], &["--hold-time is not allowed without --frames"]);
    refused(&["--frames=0..3", "--hold-time"], &["all frames would be the same", "--temporal on"]);
    refused(&["--hold-time", "-o", "a.gif"], &["--hold-time is not allowed without --frames"]);
    refused(&["--resume"], &["--resume is not allowed without --frames"]);
    refused(&["--frames=0..3", "--save-settings=ambray_0001.png"], &["the picture goes there"]);
    fs::create_dir(bench.path("2.png")).expect("folder");
    refused(&["--frames=0..3", "-o", "#.png"], &["output 2.png: is a folder"]);
    assert_eq!(bench.made(), ["2.png"]);
}

#[test]
fn reports_are_for_people_and_programs() {
    let bench = Bench::animated();
    let sequence = ["render", "moving.gltf", "--size=32x18", "--frames=0..3", "--fps=23.976", "-o", "#.png"];
    let run = bench.run(&sequence).succeeds();
    for part in ["3 frames, 0..=2, 23.976 fps", "median", "0.png to 2.png, 3 files", "32x18, 8 rays/pixel"] {
        assert!(run.text().contains(part), "{part} is missing in\n{}", run.text());
    }
    assert_eq!(run.stderr, "");
    let json = bench.run(&[&sequence[..], &["--json", "--resume"]].concat()).succeeds();
    let report: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON");
    assert_eq!((&report["kept"], &report["rendered"]), (&3.into(), &0.into()));
    assert_eq!(report["frames"].as_array().map(Vec::len), Some(3));
    assert_eq!(report["frames"][1]["outputs"][0], "1.png");
    assert!(report["frames"][2]["time"].as_f64().is_some_and(|time| (time - 2.0 / 23.976).abs() < 1e-9));
    let json = bench.run(&[&sequence[..], &["--json"]].concat()).succeeds();
    let report: serde_json::Value = serde_json::from_slice(&json.stdout).expect("JSON");
    assert_eq!(report["frames"][0]["rays"]["primary"], 32 * 18);
    assert!(report["frame_ms"]["median"].is_number() && report["write_ms"].is_number());
}

#[test]
fn what_is_there_is_kept() {
    let bench = Bench::animated();
    let sequence = ["--frames=0..4", "--fps=10", "-o", "#.png", "--aov=depth"];
    bench.animate(&sequence).succeeds();
    let first: Vec<_> = (0..4).map(|i| bench.read(&format!("{i}.png"))).collect();
    let resumed = |arguments: &[&str]| {
        let line = [&sequence[..], &["--resume", "--json"], arguments].concat();
        let run = bench.animate(&line).succeeds();
        let report: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
        let frames = report["frames"].as_array().expect("frames").iter();
        frames
            .filter(|frame| frame["kept"] == false)
            .map(|f| f["frame"].as_u64().expect("a number"))
            .collect::<Vec<_>>()
    };
    fs::remove_file(bench.path("1.png")).expect("file");
    fs::remove_file(bench.path("2.depth.png")).expect("file");
    fs::copy(bench.path("0.png"), bench.path("3.png")).expect("file");
    assert_eq!(resumed(&[]), [1, 2, 3]);
    for (i, bytes) in first.iter().enumerate() {
        assert_eq!(bench.read(&format!("{i}.png")), *bytes, "frame {i}");
    }
    assert_eq!(resumed(&[]), [0; 0]);
    assert_eq!(resumed(&["--format=png16"]), [0, 1, 2, 3]);
    assert_eq!(resumed(&["--format=png16"]), [0; 0]);
    assert_eq!(resumed(&["--format=png16", "--seed=1"]), [0, 1, 2, 3]);
    assert_eq!(resumed(&["--format=png16", "--seed=1", "--fps=20"]), [1, 2, 3]);
    // A scene that was changed later makes other pictures.
    std::thread::sleep(Duration::from_millis(20));
    bench.write("moving.gltf", &super::animated::gltf());
    assert_eq!(resumed(&["--format=png16", "--seed=1", "--fps=20"]), [0, 1, 2, 3]);
}

#[test]
fn layers_are_kept_only_if_they_are_the_same() {
    let bench = Bench::animated();
    let kept = |planes: &str| {
        let line = ["--frames=0..2", "-o", "#.exr", "--resume", "--json", planes];
        let run = bench.animate(&line).succeeds();
        let report: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
        report["kept"].as_u64()
    };
    assert_eq!(kept("--aov=depth"), Some(0));
    assert_eq!(kept("--aov=depth"), Some(2));
    assert_eq!(kept("--aov=depth,openness"), Some(0));
}

#[test]
fn pictures_cut_short_are_made_again() {
    let bench = Bench::animated();
    for (name, format) in [("0.png", "png8"), ("0.png", "png16"), ("0.exr", "exr")] {
        let output = name.replace('0', "#");
        let line = ["--frames=0..1", "-o", &output, "--format", format, "--resume", "--json"];
        let kept = || {
            let run = bench.animate(&line).succeeds();
            let report: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
            report["kept"] == 1
        };
        assert!(!kept(), "{format}");
        let whole = bench.read(name);
        for length in [whole.len() - 1, whole.len() - 12, whole.len() / 2] {
            assert!(kept(), "{format}");
            fs::write(bench.path(name), &whole[..length]).expect("file");
            assert!(!kept(), "{format}, {length} of {} bytes", whole.len());
            assert_eq!(bench.read(name), whole, "{format}");
        }
    }
}

#[test]
fn accumulated_frames_are_the_same_when_resumed() {
    let bench = Bench::animated();
    let sequence = ["--frames=0..4", "--fps=10", "--temporal=on", "-o", "#.png"];
    bench.animate(&sequence).succeeds();
    let third = bench.read("2.png");
    assert!(Png::of(&third).text("ambray:settings").contains("frame = 2"));
    assert!(Png::of(&third).text("ambray:scene").contains("accumulated from frame 0 at 10 fps"));
    fs::remove_file(bench.path("2.png")).expect("file");
    bench.animate(&[&sequence[..], &["--resume"]].concat()).succeeds();
    assert_eq!(bench.read("2.png"), third);
    // A still scene accumulates as well.
    bench.render(&["--frames=0..2", "--temporal=on", "-o", "still_#.png"]).succeeds();
    assert!(bench.path("still_1.png").exists());
}

#[test]
fn time_that_is_held_leaves_the_light_of_one_moment() {
    let bench = Bench::new();
    let moment =
        ["render", "banner", "--size=64x36", "--time=0.3", "--temporal=on", "--spp=1", "--backend=cpu"];
    bench.run(&[&moment[..], &["--frames=0..3", "--hold-time", "-o", "held_#.png"]].concat()).succeeds();
    let third = Png::of(&bench.read("held_2.png"));
    let (settings, scene) = (third.text("ambray:settings"), third.text("ambray:scene"));
    assert!(settings.contains("time = 0.3") && settings.contains("frame = 2"), "{settings}");
    assert!(scene.ends_with("accumulated from frame 0"), "{scene}");
    bench.run(&[&moment[..], &["-o", "alone.png"]].concat()).succeeds();
    let (first, alone) = (Png::of(&bench.read("held_0.png")), Png::of(&bench.read("alone.png")));
    assert!(first.bytes == alone.bytes, "the first one stands alone");
    assert!(third.bytes != alone.bytes, "the third one is their mean");
}
