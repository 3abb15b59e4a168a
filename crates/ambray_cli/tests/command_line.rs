//! The line of `command_line::render_command` is read by shell and program as it was meant.

use std::{path::Path, process::Command as Process};

use ambray::settings::{Field, Kind, Settings};
use ambray_cli::{
    args::{self, Command, Planes, RenderArgs},
    settings::resolve,
};
use ambray_files::{command_line::render_command, settings_file};
use fastrand::Rng;

/// What shells, the program and people may take for something else.
const CHARACTERS: [char; 24] = [
    'a', 'Z', '0', ' ', '\'', '"', '\\', '$', '`', '!', '*', '?', '~', '#', '&', ';', '|', '\n', '\t', '=',
    ',', '-', 'é', '❤',
];

fn name(rng: &mut Rng) -> String {
    (0..rng.usize(1..9)).map(|_| CHARACTERS[rng.usize(..CHARACTERS.len())]).collect()
}

/// A number of any magnitude.
fn number(rng: &mut Rng) -> f32 {
    match rng.u8(..4) {
        0 => f32::from_bits(rng.u32(..)),
        1 => rng.f32(),
        2 => (rng.f32() - 0.5) * 200.0,
        _ => rng.i32(-9..10) as f32 * 0.1,
    }
}

fn numbers(rng: &mut Rng, count: usize) -> String {
    (0..count).map(|_| number(rng).to_string()).collect::<Vec<_>>().join(",")
}

/// A spelling of a value of `field`, which may not be allowed.
fn value(rng: &mut Rng, field: &Field) -> String {
    match field.kind {
        kind if kind.has_auto() && rng.u8(..4) == 0 => "auto".to_owned(),
        Kind::Whole if rng.bool() => rng.u32(1..300).to_string(),
        Kind::Whole => rng.u32(..).to_string(),
        Kind::Number | Kind::AutoNumber => numbers(rng, 1),
        Kind::Flag => rng.bool().to_string(),
        Kind::Choice(choices) => choices[rng.usize(..choices.len())].0.to_owned(),
        Kind::Size => format!("{}x{}", rng.u32(1..4000), rng.u32(1..4000)),
        Kind::Rgb | Kind::AutoRgb | Kind::AutoTriple => numbers(rng, 3),
        Kind::AutoRange => numbers(rng, 2),
        Kind::AutoText => name(rng),
    }
}

/// Settings of which about half are not the default; all are allowed.
fn settings(rng: &mut Rng) -> Settings {
    let mut settings = Settings::default();
    for field in Settings::fields() {
        for _ in 0..rng.usize(..8) {
            let mut changed = settings.clone();
            changed.set(field.name, &value(rng, field)).expect("a value of the kind");
            if changed.validate().is_empty() {
                settings = changed;
            }
        }
    }
    settings
}

fn parse(words: Vec<String>) -> Box<RenderArgs> {
    match args::parse_from(words.clone()) {
        Ok(Command::Render(args)) => args,
        Ok(other) => panic!("{words:?} is {other:?}"),
        Err(error) => panic!("{words:?}: {error}"),
    }
}

#[track_caller]
fn check(settings: &Settings, scene: &str, gltf_scene: Option<&str>, words: Vec<String>) {
    let args = parse(words);
    assert_eq!(args.scene.scene, Path::new(scene));
    assert_eq!(args.scene.gltf_scene.as_deref(), gltf_scene);
    assert_eq!(args.aov, [Planes::All]);
    let read = resolve(&args.settings).expect("the settings are allowed");
    assert_eq!(&read, settings);
    // Files tell -0 from 0, which are equal.
    assert_eq!(settings_file::write(&read), settings_file::write(settings));
}

fn line(settings: &Settings, scene: &str, gltf_scene: Option<&str>) -> String {
    render_command(Path::new(scene), gltf_scene, settings, &["--aov=all".to_owned()])
}

#[test]
fn the_line_is_read_as_the_same_settings_bit_for_bit() {
    let mut rng = Rng::with_seed(5);
    let mut changed = vec![0; Settings::fields().len()];
    for _ in 0..300 {
        let (settings, scene, part) = (settings(&mut rng), format!("a{}", name(&mut rng)), name(&mut rng));
        for (count, field) in changed.iter_mut().zip(Settings::fields()) {
            *count += usize::from(settings.get(field.name) != Settings::default().get(field.name));
        }
        let line = line(&settings, &scene, Some(&part));
        check(&settings, &scene, Some(&part), shlex::split(&line).expect("quotes are closed"));
    }
    for (count, field) in changed.iter().zip(Settings::fields()) {
        assert!(*count > 20, "{} was changed {count} times", field.name);
    }
}

#[test]
fn the_default_and_empty_names_are_read_back() {
    let mut settings = Settings::default();
    check(&settings, "atrium", None, shlex::split(&line(&settings, "atrium", None)).unwrap());
    settings.set("camera", "").unwrap();
    check(&settings, "atrium", None, shlex::split(&line(&settings, "atrium", None)).unwrap());
}

#[cfg(unix)]
#[test]
fn the_shell_itself_reads_the_line_as_it_was_meant() {
    let mut rng = Rng::with_seed(6);
    for _ in 0..20 {
        let (settings, scene) = (settings(&mut rng), format!("a{}", name(&mut rng)));
        let script =
            format!("ambray() {{ printf '%s\\0' ambray \"$@\"; }}\n{}", line(&settings, &scene, None));
        let output = Process::new("sh").arg("-c").arg(script).output().expect("a shell");
        let told = String::from_utf8(output.stdout).expect("names are UTF-8");
        let words = told.split_terminator('\0').map(str::to_owned).collect();
        check(&settings, &scene, None, words);
    }
}
