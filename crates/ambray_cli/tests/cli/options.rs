//! Where settings come from, who wins, and how wrong ones are told.

use ambray::settings::Settings;

use super::{Bench, Png};

fn spp(bench: &Bench) -> i64 {
    let table: toml::Table = bench.read_text("saved.toml").parse().expect("a settings file");
    table["spp"].as_integer().expect("a number")
}

#[test]
fn flags_beat_file_beats_preset_beats_default() {
    let bench = Bench::new();
    bench.write("preset.toml", "preset = \"draft\"\n");
    bench.write("both.toml", "preset = \"draft\"\nspp = 5\n");
    let check = |arguments: &[&str], expected: i64| {
        bench.render(&[arguments, &["--save-settings=saved.toml"]].concat()).succeeds();
        assert_eq!(spp(&bench), expected, "{arguments:?}");
    };
    check(&[], 8);
    check(&["--preset=draft"], 4);
    check(&["--settings=preset.toml"], 4);
    check(&["--settings=preset.toml", "--preset=realtime"], 8);
    check(&["--settings=both.toml"], 5);
    check(&["--settings=both.toml", "--preset=realtime"], 5);
    check(&["--settings=both.toml", "--preset=realtime", "--spp=3"], 3);
}

#[test]
fn saved_settings_make_the_same_picture() {
    let bench = Bench::new();
    let odd =
        ["--spp=5", "--exponent=1.7", "--thin=sheet", "--ambient=0.2,0.5,1", "--seed=9", "--exposure=-0.3"];
    bench.render(&[&odd[..], &["-o", "a.png", "--save-settings=a.toml"]].concat()).succeeds();
    bench.run(&["render", "scene.obj", "-o", "b.png", "--settings=a.toml", "-q"]).succeeds();
    assert_eq!(bench.read("a.png"), bench.read("b.png"));
    // The picture itself holds its settings too.
    bench
        .run(&["render", "scene.obj", "-o", "c.png", "--settings=a.png", "--save-settings=c.toml"])
        .succeeds();
    assert_eq!(bench.read("a.png"), bench.read("c.png"));
    assert_eq!(bench.read("a.toml"), bench.read("c.toml"));
    bench.run(&["render", "scene.obj", "-o", "a.exr", "--settings=a.toml"]).succeeds();
    bench.run(&["render", "scene.obj", "-o", "e.png", "--settings=a.exr"]).succeeds();
    assert_eq!(bench.read("a.png"), bench.read("e.png"));
    assert_eq!(Png::of(&bench.read("a.png")).text("ambray:settings"), bench.read_text("a.toml"));
    bench.render(&["-o", "d.png"]).succeeds();
    assert_ne!(bench.read("a.png"), bench.read("d.png"), "the settings had no effect");
}

#[test]
fn every_setting_is_accepted_in_file_and_flag() {
    let bench = Bench::new();
    let defaults = toml::Table::try_from(Settings::default()).expect("settings");
    bench.write("defaults.toml", &toml::to_string(&defaults).expect("text"));
    bench.render(&["-o", "default.png"]).succeeds();
    bench.render(&["-o", "file.png", "--settings=defaults.toml"]).succeeds();
    assert_eq!(bench.read("default.png"), bench.read("file.png"));
    let spelled = |value: &toml::Value| match value {
        toml::Value::String(text) => text.clone(),
        toml::Value::Array(items) => items.iter().map(ToString::to_string).collect::<Vec<_>>().join(","),
        other => other.to_string(),
    };
    let flags: Vec<String> = defaults
        .iter()
        .filter(|(name, _)| !["size", "radius"].contains(&name.as_str()))
        .map(|(name, value)| format!("--{name}={}", spelled(value)))
        .collect();
    let flags: Vec<&str> = flags.iter().map(String::as_str).chain(["-o", "flags.png"]).collect();
    bench.render(&flags).succeeds();
    assert_eq!(bench.read("default.png"), bench.read("flags.png"));
}

#[test]
fn every_problem_is_told_with_option_value_and_range() {
    let bench = Bench::new();
    bench.write("wrong.toml", "exponent = -2\n");
    let run =
        bench.render(&["--spp=0", "--radius=-1", "--sun-color=-1,0,0", "--settings=wrong.toml"]).fails(&[
            "ambray: error: --spp 0 is not allowed: 1 to 65536",
            "ambray: error: --radius -1 is not allowed: auto or 1e-15 to 1e15",
            "ambray: error: --sun-color -1,0,0 is not allowed",
            "ambray: error: wrong.toml: exponent -2 is not allowed: 1e-15 to 1e15",
        ]);
    assert_eq!(run.stderr.lines().count(), 4, "{}", run.stderr);
    bench.render(&["--size=0x5"]).fails(&["--size 0x5", "1 to 32768"]);
    bench.render(&["--radius=nan"]).fails(&["--radius NaN", "1e-15 to 1e15"]);
    bench.render(&["--vertical-fov=180"]).fails(&["--vertical-fov 180", "below 180"]);
    bench.render(&["--camera=nave"]).fails(&["ambray: error: --camera nave"]);
    bench.render(&["--camera-position=1,1,1", "--camera-target=1,1,1"]).fails(&["error: --camera-target"]);
    assert_eq!(bench.files(), ["wrong.toml"]);
}

#[test]
fn wrong_command_lines_are_told_in_one_line() {
    let bench = Bench::new();
    let check = |arguments: &[&str], expected: &str| {
        let run = bench.run(arguments).fails(&[]);
        assert_eq!(run.stderr, expected, "{arguments:?}");
    };
    check(&["render", "--spp=x"], "ambray: error: --spp x is not allowed: a whole number, 1 to 65536\n");
    check(
        &["render", "--sise=1x1"],
        "ambray: error: there is no option --sise\n  hint: did you mean --size?\n",
    );
    check(&["query", "scene.obj"], "ambray: error: --points is missing\n");
    check(&["diff"], "ambray: error: PICTURE and REFERENCE are missing\n");
    check(&["diff", "a.png"], "ambray: error: REFERENCE is missing\n");
    check(
        &["scene.obj"],
        "ambray: error: there is no command scene.obj\n  hint: to render a scene: ambray render scene.obj ...\n",
    );
    bench.render(&["-o", "."]).fails(&["output .: is a folder", "hint: to write into it: -o ./ambray.png"]);
    assert_eq!(bench.files(), [""; 0]);
}

#[test]
fn names_in_scenes_do_not_command_the_terminal() {
    let bench = Bench::animated();
    let scene = super::animated::gltf().replace("Slide", r"\u001b[2J\u009b31m\r\nambray: fine");
    bench.write("moving.gltf", &scene);
    for asked in ["--animation=nope", "--animation=\u{1b}[2J"] {
        let run = bench.animate(&[asked]).fails(&[r"\u{1b}[2J\u{9b}31m", "Bend"]);
        assert_eq!(run.stderr.lines().count(), 1, "{}", run.stderr);
        assert!(!run.stderr.trim_end().contains(char::is_control), "{:?}", run.stderr);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn pictures_beyond_the_memory_are_refused() {
    let bench = Bench::new();
    // 268 million pixels with all planes take about 150 GB.
    if ambray_cli::machine::free_memory().is_some_and(|free| free < 100_000_000_000) {
        let huge = ["--size=16384x16384", "--aov=all", "-o", "huge.exr"];
        bench.render(&huge).fails(&["--size 16384x16384", " GB of memory"]);
        assert_eq!(bench.files(), [""; 0]);
    }
}

#[test]
fn wrong_settings_files_name_line_key_and_what_is_allowed() {
    let bench = Bench::new();
    let check = |text: &str, parts: &[&str]| {
        bench.write("s.toml", text);
        bench.render(&["--settings=s.toml"]).fails(parts);
    };
    check("spp = 8\nraduis = 1\n", &["s.toml:2: there is no setting raduis: did you mean radius?"]);
    check("\n\nthin = \"thick\"\n", &["s.toml:3: thin = \"thick\" is not allowed", "`sheet`"]);
    check("radius = \"wide\"\n", &["s.toml:1: radius = \"wide\" is not allowed", "\"auto\"", "scene units"]);
    check("preset = \"best\"\n", &["s.toml:1: preset = \"best\" is not allowed", "`reference`"]);
    check("spp = \"8\"\nsize = 4\n", &["s.toml:1: spp", "s.toml:2: size"]);
    check("spp 8\n", &["s.toml:1: "]);
    bench.render(&["--settings=none.toml"]).fails(&["settings file none.toml"]);
    bench.render(&["--settings=."]).fails(&["settings file ."]);
    std::fs::write(bench.path("s.toml"), b"\xff\xfe").expect("file");
    bench.render(&["--settings=s.toml"]).fails(&["s.toml", "UTF-8"]);
    assert_eq!(bench.files(), ["s.toml"]);
}

#[test]
fn scenes_that_are_not_there_are_told() {
    let bench = Bench::new();
    bench.run(&["render", "none.glb"]).fails(&["ambray: error: none.glb", "hint:", "atrium"]);
    bench.run(&["render", "./atrium"]).fails(&["./atrium"]);
    bench.run(&["render", "."]).fails(&["ambray: error: ."]);
    bench.write("broken.gltf", "{");
    bench.run(&["render", "broken.gltf"]).fails(&["broken.gltf"]);
    bench.run(&["render", "scene.obj", "--gltf-scene=1"]).fails(&["--gltf-scene", "scene.obj"]);
    assert_eq!(bench.files(), ["broken.gltf"]);
}

#[test]
fn threads_do_not_change_the_picture() {
    let bench = Bench::new();
    bench.render(&["--threads=1", "-o", "one.png"]).succeeds();
    bench.render(&["--threads=3", "-o", "three.png"]).succeeds();
    assert_eq!(bench.read("one.png"), bench.read("three.png"));
}
