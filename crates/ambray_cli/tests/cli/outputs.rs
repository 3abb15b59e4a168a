//! Files, formats, planes and reports of `ambray render`.

use std::process::Stdio;

use ambray::{Aov, display, settings::Ramp};
use exr::prelude::{AttributeValue, FlatSamples, Text};

use super::{Bench, Png, exists};

#[test]
fn picture_is_an_8_bit_png_with_texts() {
    let bench = Bench::new();
    // Without colour bleeding, since white surfaces in white light are white all over.
    let run =
        bench.run(&["render", "scene.obj", "--size=64x36", "--radius=2", "--near-radiance=off"]).succeeds();
    assert_eq!(bench.files(), ["ambray.png"]);
    for part in ["scene.obj: 4 triangles", "64x36", "8 rays/pixel", "ambray.png", "primary", "view     "] {
        assert!(run.text().contains(part), "{part} is missing in\n{}", run.text());
    }
    assert_eq!(run.stderr, "");
    let picture = Png::of(&bench.read("ambray.png"));
    assert_eq!(picture.size, (64, 36));
    assert_eq!((picture.color, picture.depth), (png::ColorType::Rgb, png::BitDepth::Eight));
    assert!(picture.text("ambray:settings").contains("size = \"64x36\""));
    assert!(picture.text("Software").starts_with("ambray "));
    assert_eq!(picture.text("ambray:scene"), "scene.obj");
    let distinct: std::collections::BTreeSet<_> = picture.bytes.chunks(3).collect();
    assert!(distinct.len() > 10, "the picture is flat");
}

#[test]
fn quiet_says_nothing() {
    let bench = Bench::new();
    let run = bench.render(&["-o", "deep.png", "--format=png16"]).succeeds();
    assert_eq!((run.text().as_str(), run.stderr.as_str()), ("", ""));
    assert_eq!(Png::of(&bench.read("deep.png")).depth, png::BitDepth::Sixteen);
}

#[test]
fn planes_become_png_files() {
    let bench = Bench::new();
    bench.render(&["-o", "out.png", "--aov=openness,depth,material,depth"]).succeeds();
    assert_eq!(bench.files(), ["out.depth.png", "out.material.png", "out.openness.png", "out.png"]);
    let openness = Png::of(&bench.read("out.openness.png"));
    assert_eq!((openness.size, openness.color), ((64, 36), png::ColorType::Grayscale));
    assert_eq!(Png::of(&bench.read("out.material.png")).color, png::ColorType::Rgb);
    bench.render(&["-o", "all.png", "--aov=all"]).succeeds();
    for aov in Aov::ALL.iter().filter(|aov| **aov != Aov::Beauty) {
        assert_eq!(Png::of(&bench.read(&format!("all.{aov}.png"))).size, (64, 36), "{aov}");
    }
}

/// The channels of an EXR file with their values.
pub(super) fn channels(bench: &Bench, name: &str) -> Vec<(String, Vec<f32>)> {
    let image = exr::prelude::read_first_flat_layer_from_file(bench.path(name)).expect("an EXR file");
    assert_eq!((image.layer_data.size.0, image.layer_data.size.1), (64, 36));
    let channels = image.layer_data.channel_data.list.into_iter().map(|channel| match channel.sample_data {
        FlatSamples::F32(values) => (channel.name.to_string(), values),
        other => panic!("{}: {other:?}", channel.name),
    });
    channels.collect()
}

#[test]
fn planes_become_layers_of_one_exr_file() {
    let bench = Bench::new();
    bench.render(&["-o", "out.exr", "--aov=openness,depth,shading-normal"]).succeeds();
    assert_eq!(bench.files(), ["out.exr"]);
    let found = channels(&bench, "out.exr");
    let names: Vec<_> = found.iter().map(|(name, _)| name.as_str()).collect();
    let normal = ["shading-normal.X", "shading-normal.Y", "shading-normal.Z"];
    assert_eq!(names, [&["B", "G", "R", "depth.Z", "openness.Y"], &normal[..]].concat());
    let openness = &found[4].1;
    assert!(openness.iter().all(|o| (0.0..=1.0).contains(o)) && openness.iter().any(|o| *o < 0.95));

    // The PNG shows the same values: display value = openness.
    bench.render(&["-o", "out.png", "--aov=openness"]).succeeds();
    let shown = Png::of(&bench.read("out.openness.png"));
    for (value, byte) in openness.iter().zip(&shown.bytes) {
        assert_eq!((value * 255.0).round() as u8, *byte, "{value}");
    }

    bench.render(&["-o", "all.exr", "--aov=all"]).succeeds();
    let expected: usize = Aov::ALL.iter().map(|aov| aov.channels().len()).sum();
    assert_eq!(channels(&bench, "all.exr").len(), expected);
}

#[test]
fn scalars_are_shown_in_the_ramp_and_the_range_that_were_asked_for() {
    let bench = Bench::new();
    let shown = |arguments: &[&str]| {
        bench.render(&[arguments, &["-o", "out.png", "--aov=depth,openness"]].concat()).succeeds();
        ["out.depth.png", "out.openness.png", "out.png"].map(|name| Png::of(&bench.read(name)))
    };
    let [depth, openness, picture] = shown(&[]);
    assert_eq!([depth.color, openness.color], [png::ColorType::Grayscale; 2]);
    let [coloured_depth, coloured, same] = shown(&["--ramp=viridis"]);
    assert_eq!([coloured_depth.color, coloured.color], [png::ColorType::Rgb; 2]);
    assert_eq!(picture.bytes, same.bytes, "the picture itself has no ramp");
    for (grey, colour) in openness.bytes.iter().zip(coloured.bytes.chunks_exact(3)) {
        let expected = 255.0 * display::shade(Ramp::Viridis, f32::from(*grey) / 255.0);
        let is_near = |(&a, e): (&u8, f32)| (f32::from(a) - e).abs() <= 4.0; // the grey was rounded
        assert!(colour.iter().zip(expected.to_array()).all(is_near), "{grey} {colour:?} {expected}");
    }
    let [_, halved, _] = shown(&["--range=0,2"]);
    for (all, half) in openness.bytes.iter().zip(&halved.bytes) {
        assert!((i16::from(*all) - 2 * i16::from(*half)).abs() <= 1, "{all} {half}");
    }
    bench.render(&["--range=2,1"]).fails(&["--range 2,1 is not allowed", "the smaller first"]);
    bench.render(&["--range=2"]).fails(&["--range 2 is not allowed", "LOW,HIGH"]);
}

#[test]
fn exr_header_tells_software_settings_and_camera() {
    let bench = Bench::new();
    let view = ["--camera-position=0,1,3", "--camera-target=0,1,0", "--vertical-fov=60"];
    bench.render(&[&view[..], &["-o", "a.exr", "--save-settings=a.toml"]].concat()).succeeds();
    bench.render(&[&view[..], &["-o", "b.exr"]].concat()).succeeds();
    assert_eq!(bench.read("a.exr"), bench.read("b.exr"), "the same picture has other bytes");
    let image = exr::prelude::read_first_flat_layer_from_file(bench.path("a.exr")).expect("an EXR file");
    let header = image.layer_data.attributes;
    assert!(header.software_name.expect("software").to_string().starts_with("ambray "));
    let settings = header.other.get(&Text::from("ambraySettings")).expect("settings");
    let AttributeValue::Text(settings) = settings else { panic!("{settings:?}") };
    assert_eq!(settings.to_string(), bench.read_text("a.toml"));
    assert!((header.vertical_field_of_view.expect("angle") - 60.0).abs() < 1e-3);
    // The eye is the origin, x goes right, y up, z forward.
    let m = header.world_to_camera.expect("matrix");
    let camera = |p: [f32; 3]| -> [f32; 3] {
        std::array::from_fn(|c| (0..3).map(|r| p[r] * m[4 * r + c]).sum::<f32>() + m[12 + c])
    };
    for (point, expected) in [([0.0, 1.0, 3.0], [0.0; 3]), ([0.5, 1.0, 0.0], [0.5, 0.0, 3.0])] {
        let actual = camera(point);
        assert!(actual.iter().zip(expected).all(|(a, e)| (a - e).abs() < 1e-4), "{actual:?} {expected:?}");
    }
}

#[test]
fn stdout_takes_the_picture() {
    let bench = Bench::new();
    bench.render(&["-o", "file.png"]).succeeds();
    let run = bench.render(&["-o", "-"]).succeeds();
    assert_eq!(run.stdout, bench.read("file.png"));
    let run =
        bench.run(&["render", "scene.obj", "--size=64x36", "-o-", "--format=exr", "--aov=depth"]).succeeds();
    assert_eq!(run.stdout[..4], [0x76, 0x2f, 0x31, 0x01]);
    assert!(run.stderr.contains("4 triangles"), "the report goes to stderr: {}", run.stderr);
    bench.render(&["-o", "-", "--aov=depth"]).fails(&["--aov", "--format exr"]);
    bench.render(&["-o", "-", "--json"]).fails(&["--json", "-o -"]);
    assert_eq!(bench.files(), ["file.png"]);
}

#[test]
fn closed_stdout_is_no_error() {
    let bench = Bench::new();
    let mut child = bench
        .command(&["info", "scene.obj"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("start");
    drop(child.stdout.take());
    let output = child.wait_with_output().expect("end");
    assert_eq!((output.status.code(), String::from_utf8_lossy(&output.stderr).as_ref()), (Some(0), ""));
}

#[test]
fn json_is_the_only_thing_on_stdout() {
    let bench = Bench::new();
    let run = bench
        .run(&["render", "scene.obj", "--size=64x36", "--radius=0.5", "--json", "-o", "x.png"])
        .succeeds();
    let report: serde_json::Value = serde_json::from_slice(&run.stdout).expect("JSON");
    assert_eq!(report["scene"]["triangles"], 4);
    assert_eq!(report["scene"]["source"], "scene.obj");
    assert_eq!(report["view"]["radius"], 0.5);
    assert_eq!(report["width"], 64);
    assert_eq!(report["rays"]["primary"], 64 * 36);
    assert_eq!(report["outputs"][0], "x.png");
    assert_eq!(report["settings"]["size"], "64x36");
    for path in ["/build/build_ms", "/times/total_ms", "/times/ambient_ms", "/rays/mrays_per_s", "/write_ms"]
    {
        assert!(report.pointer(path).is_some_and(serde_json::Value::is_number), "{path}");
    }
    assert_eq!(report["view"]["camera"]["position"].as_array().map(Vec::len), Some(3));
}

#[test]
fn outputs_that_cannot_be_are_refused_before_the_work() {
    let bench = Bench::new();
    // So many rays that only an early refusal ends soon.
    let slow = ["render", "scene.obj", "--size=4096x4096", "--spp=65536"];
    let refused = |arguments: &[&str], parts: &[&str]| {
        bench.run(&[&slow[..], arguments].concat()).fails(parts);
    };
    std::fs::create_dir(bench.path("folder.png")).expect("folder");
    refused(&["-o", "no/out.png"], &["no/out.png", "the folder no does not exist"]);
    refused(&["-o", "folder.png"], &["folder.png: is a folder"]);
    refused(&["-o", "out.jpg"], &["out.jpg", ".png and .exr", "hint"]);
    refused(&["-o", "out"], &["out: ", ".png and .exr"]);
    refused(&["-o", ""], &["--output"]);
    refused(&["-o", ".."], &["is a folder"]);
    refused(&["-o", "out.exr", "--format=png8"], &["out.exr", "png8"]);
    refused(&["-o", "scene.obj/x.png"], &["does not exist"]);
    refused(&["--save-settings=no/s.toml"], &["no/s.toml"]);
    refused(&["--save-settings=ambray.png"], &["ambray.png"]);
    assert_eq!(bench.files(), ["folder.png"]);
}

#[cfg(target_os = "linux")]
#[test]
fn full_disk_leaves_nothing_behind() {
    let bench = Bench::new();
    bench.write("out.png", "old");
    // /dev/full accepts no byte; the settings come after the picture.
    bench.render(&["-o", "out.png", "--save-settings=/dev/full"]);
    assert_eq!(bench.files(), ["out.png"]);
    bench.render(&["-o", "/dev/full", "--format=png8"]).fails(&["/dev/full", "No space left"]);
    bench.render(&["-o", "/dev/null", "--format=exr"]).succeeds();
    assert!(exists(std::path::Path::new("/dev/null")));
    assert_eq!(bench.files(), ["out.png"]);
}
