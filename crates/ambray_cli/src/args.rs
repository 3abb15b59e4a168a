//! The command line as it was typed: parsed and checked for form, without side effects.

mod animate;
mod backend;
mod compare;
mod diff;
mod notes;
mod rays;
mod sequence;
mod view;

use std::{ffi::OsString, fmt::Display, path::PathBuf, str::FromStr};

use ambray::{
    Aov,
    settings::{Auto, Kind, Preset, Range, Rgb, Settings, SettingsPatch, Size, Triple, Value},
};
use clap::{
    Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum,
    builder::{PossibleValue, PossibleValuesParser, TypedValueParser},
};

pub use animate::{AnimateArgs, Updates, UpdatesArgs};
use notes::{
    BENCH_NOTES, COMPARE_NOTES, DIFF_NOTES, EXAMPLES, POINTS_HELP, PRECEDENCE, RENDER_NOTES, VIEW_NOTES,
};

pub use ambray_files::{Format, Rate};
pub use backend::{Backend, BackendArgs, DeviceArgs, Grouping, GroupingArgs, Trace};
pub use compare::CompareArgs;
pub use diff::DiffArgs;
pub use rays::{KernelArgs, Kernels, Packets, Quality, RaysArgs};
pub use sequence::{Frames, SequenceArgs};
pub use view::ViewArgs;

/// Ambient lighting by ray tracing: openness, colour bleeding and pictures.
///
/// Without a command, the built-in scene atrium is rendered to ambray.png in the current folder.
#[derive(Debug, Parser)]
#[command(name = "ambray", version, max_term_width = 100, after_long_help = EXAMPLES)]
pub struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

/// What to do.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Render a scene to a picture
    #[command(after_long_help = RENDER_NOTES.to_owned() + PRECEDENCE)]
    Render(Box<RenderArgs>),
    /// Open a window to see and tune ambient light live
    #[command(after_long_help = VIEW_NOTES.to_owned() + PRECEDENCE)]
    View(Box<ViewArgs>),
    /// Evaluate ambient light at points of a list instead of pixels
    #[command(after_long_help = PRECEDENCE)]
    Query(Box<QueryArgs>),
    /// Compare with the truth and with other methods, in a report; or make the paper's figures
    #[command(after_long_help = COMPARE_NOTES.to_owned() + PRECEDENCE)]
    Compare(Box<CompareArgs>),
    /// Measure the time of whole frames, or of their rays alone
    #[command(after_long_help = BENCH_NOTES.to_owned() + PRECEDENCE)]
    Bench(Box<BenchArgs>),
    /// Say how far a picture is from another, layer by layer
    #[command(after_long_help = DIFF_NOTES)]
    Diff(Box<DiffArgs>),
    /// Say what is in a scene; without one, about the program and the machine
    Info(InfoArgs),
    /// Print a script that completes ambray's options in a shell
    Completions(CompletionsArgs),
    /// Print the manual page (roff)
    #[command(hide = true)]
    Man,
}

/// Which scene to load.
#[derive(Clone, Debug, Args)]
pub struct SceneArgs {
    /// Scene: a .gltf, .glb or .obj file, or a built-in one: atrium, or banner and flock, which move (a file of that name:
    /// ./atrium)
    #[arg(value_name = "SCENE", default_value = "atrium")]
    pub scene: PathBuf,
    /// Scene of a glTF file by number from 0 or by name [default: the one that the file names, else the first]
    #[arg(long, value_name = "NAME_OR_INDEX")]
    pub gltf_scene: Option<String>,
}

/// Where settings come from.
#[derive(Clone, Debug, Default, Args)]
pub struct SettingsArgs {
    /// Starting point for quality and speed; a settings file and flags have the last word [default: realtime]
    #[arg(long, value_enum, value_name = "PRESET", help_heading = "Settings")]
    pub preset: Option<Preset>,
    /// Read settings from a TOML file, or from a picture that ambray wrote
    #[arg(long, value_name = "FILE", help_heading = "Settings")]
    pub settings: Option<PathBuf>,
    /// Write all settings in use to a TOML file, from which --settings makes the same picture again; of a window, those in
    /// use when it is closed
    #[arg(long, value_name = "FILE.toml", help_heading = "Settings")]
    pub save_settings: Option<PathBuf>,
    /// Settings given as flags.
    #[command(flatten)]
    pub flags: SettingsPatch,
}

/// How to run.
#[derive(Clone, Copy, Debug, Args)]
pub struct RunArgs {
    /// Number of threads of the CPU backend, 0 for all cores; the result does not depend on it
    #[arg(long, value_name = "N", default_value_t = 0, value_parser = |text: &str| whole::<u16>(text, 0, 1024))]
    pub threads: u16,
    /// No progress bar and no report; warnings and errors are still shown on stderr
    #[arg(short, long)]
    pub quiet: bool,
}

/// Arguments of `ambray render`.
#[derive(Clone, Debug, Args)]
pub struct RenderArgs {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Picture to write, .png or .exr; - is stdout. Of a sequence (--frames), a run of # in the name is the number of the
    /// frame, by default ambray_####. Or a video: .gif, or .mp4, .webm and .webp with ffmpeg; without --frames it shows the
    /// whole animation [default: ambray.png, or ambray.exr with --format exr]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// File format [default: by the extension of OUT; png8 for .png]
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub format: Option<Format>,
    /// More planes to write besides the picture, separated by commas: layers of the same file in OpenEXR, files
    /// OUT-stem.PLANE.png in PNG
    #[arg(long, value_name = "PLANES", value_delimiter = ',', value_parser = planes())]
    pub aov: Vec<Planes>,
    /// Print the report as one JSON object on stdout; of a sequence, with a list of all frames
    #[arg(long)]
    pub json: bool,
    /// Which frames.
    #[command(flatten)]
    pub sequence: SequenceArgs,
    /// How to run.
    #[command(flatten)]
    pub run: RunArgs,
    /// Who renders.
    #[command(flatten)]
    pub backend: BackendArgs,
    /// How acceleration structures follow what deforms.
    #[command(flatten)]
    pub updates: UpdatesArgs,
    /// Settings.
    #[command(flatten)]
    pub settings: SettingsArgs,
}

/// Arguments of `ambray query`.
#[derive(Clone, Debug, Args)]
pub struct QueryArgs {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Points in the scene.
    #[arg(long, value_name = "FILE", help = POINTS_HELP)]
    pub points: PathBuf,
    /// Format of the points [default: JSON lines if the first character is {, else CSV]
    #[arg(long, value_enum, value_name = "FORMAT")]
    pub points_format: Option<PointsFormat>,
    /// File for the results; - is stdout, where they appear as they come [default: -]
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// Results as JSON lines instead of CSV
    #[arg(long)]
    pub json: bool,
    /// How to run.
    #[command(flatten)]
    pub run: RunArgs,
    /// Who renders.
    #[command(flatten)]
    pub backend: BackendArgs,
    /// Settings.
    #[command(flatten)]
    pub settings: SettingsArgs,
}

/// Arguments of `ambray bench`.
#[derive(Clone, Debug, Args)]
pub struct BenchArgs {
    /// Scenes: .gltf, .glb or .obj files, or built-in ones: atrium, or banner and flock, which move [default: atrium; with
    /// --rays none]
    #[arg(value_name = "SCENE")]
    pub scenes: Vec<PathBuf>,
    /// Scene of each glTF file by number from 0 or by name [default: the one that the file names, else the first]
    #[arg(long, value_name = "NAME_OR_INDEX")]
    pub gltf_scene: Option<String>,
    /// Frames to measure per scene, at least [default: 100]
    #[arg(long, value_name = "N", value_parser = |text: &str| whole::<u32>(text, 1, 1_000_000))]
    pub frames: Option<u32>,
    /// Seconds to measure per scene, at least: frames go on until both --frames and --seconds are reached
    #[arg(long, value_name = "SECONDS", default_value_t = 0.0, value_parser = seconds)]
    pub seconds: f64,
    /// Frames to render before, which do not count
    #[arg(long, value_name = "N", default_value_t = 5, value_parser = |text: &str| whole::<u32>(text, 0, 1_000_000))]
    pub warmup: u32,
    /// Also print what the frame costs: rays a pixel, and bytes that each pass of a Vulkan device must move with the time
    /// that its memory needs for them (always in JSON)
    #[arg(long)]
    pub cost: bool,
    /// Bandwidth of the memory of the Vulkan device for --cost, GB/s, reading and writing together [default: measured with
    /// large copies]
    #[arg(long, value_name = "GB/S", value_parser = bandwidth)]
    pub bandwidth: Option<f64>,
    /// Measure what thin detection costs: the same frame with --thin off, paper and sheet in turn, at 1920x1080 with 8 rays
    /// unless --size and --spp say otherwise
    #[arg(long)]
    pub thin_cost: bool,
    /// Scenes that move.
    #[command(flatten)]
    pub animate: AnimateArgs,
    /// Rays alone.
    #[command(flatten)]
    pub rays: RaysArgs,
    /// The processor's kernels.
    #[command(flatten)]
    pub kernels: KernelArgs,
    /// Print the result as one JSON object on stdout
    #[arg(long)]
    pub json: bool,
    /// Write the result as JSON to a file as well
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// How to run.
    #[command(flatten)]
    pub run: RunArgs,
    /// Who renders.
    #[command(flatten)]
    pub backend: BackendArgs,
    /// What shares an acceleration structure.
    #[command(flatten)]
    pub grouping: GroupingArgs,
    /// How they follow what deforms.
    #[command(flatten)]
    pub updates: UpdatesArgs,
    /// Settings.
    #[command(flatten)]
    pub settings: SettingsArgs,
}

impl BenchArgs {
    /// The scenes to render: the built-in one if none is named.
    #[must_use]
    pub fn rendered(&self) -> Vec<PathBuf> {
        if self.scenes.is_empty() { vec![PathBuf::from("atrium")] } else { self.scenes.clone() }
    }
}

/// Arguments of `ambray info`.
#[derive(Clone, Debug, Args)]
pub struct InfoArgs {
    /// Scene: a .gltf, .glb or .obj file, or a built-in one: atrium, banner or flock; none tells about the program
    #[arg(value_name = "SCENE")]
    pub scene: Option<PathBuf>,
    /// Scene of a glTF file by number from 0 or by name [default: the one that the file names, else the first]
    #[arg(long, value_name = "NAME_OR_INDEX")]
    pub gltf_scene: Option<String>,
    /// List the Vulkan devices of this machine, and which one is taken by itself
    #[arg(long)]
    pub devices: bool,
    /// Build the scene's acceleration structures on a Vulkan device, and tell their numbers
    #[arg(long)]
    pub acceleration: bool,
    /// Print one JSON object on stdout
    #[arg(long)]
    pub json: bool,
    /// The device of --acceleration.
    #[command(flatten)]
    pub device: DeviceArgs,
    /// What shares an acceleration structure.
    #[command(flatten)]
    pub grouping: GroupingArgs,
}

/// Arguments of `ambray completions`.
#[derive(Clone, Copy, Debug, Args)]
pub struct CompletionsArgs {
    /// Shell to write for
    #[arg(value_enum, value_name = "SHELL")]
    pub shell: clap_complete::Shell,
}

/// Format of a list of points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
pub enum PointsFormat {
    /// Comma-separated columns
    Csv,
    /// One JSON object a line
    Jsonl,
}

/// An element of the list of `--aov`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Planes {
    /// Every plane there is.
    All,
    /// This one.
    One(Aov),
}

impl FromStr for Planes {
    type Err = String;

    fn from_str(name: &str) -> Result<Self, String> {
        if name == "all" { Ok(Self::All) } else { name.parse().map(Self::One) }
    }
}

impl Planes {
    /// The planes of a list.
    #[must_use]
    pub fn of(list: &[Self]) -> Vec<Aov> {
        let planes = list.iter().flat_map(|planes| match planes {
            Self::All => Aov::ALL,
            Self::One(aov) => std::slice::from_ref(aov),
        });
        planes.copied().collect()
    }
}

fn planes() -> impl TypedValueParser<Value = Planes> {
    let all = PossibleValue::new("all").help("Every plane below");
    let each = Aov::ALL.iter().map(|aov| PossibleValue::new(aov.name()).help(aov.description()));
    PossibleValuesParser::new(std::iter::once(all).chain(each)).try_map(|name| name.parse::<Planes>())
}

fn seconds(text: &str) -> Result<f64, String> {
    let expected = "seconds from 0 to 86400";
    let seconds: f64 = text.parse().map_err(|_| expected)?;
    if (0.0..=86_400.0).contains(&seconds) { Ok(seconds) } else { Err(expected.to_owned()) }
}

fn bandwidth(text: &str) -> Result<f64, String> {
    let gigabytes = text.parse().ok().filter(|number| (1e-3..=1e6).contains(number));
    gigabytes.ok_or_else(|| "gigabytes a second from 0.001 to 1000000".to_owned())
}

fn whole<T: FromStr + PartialOrd + Display>(text: &str, least: T, most: T) -> Result<T, String> {
    let number = text.parse().ok().filter(|number| (&least..=&most).contains(&number));
    number.ok_or_else(|| format!("a whole number, {least} to {most}"))
}

/// The command line as clap knows it, with the default of each setting in its help.
#[must_use]
pub fn command() -> clap::Command {
    let with_settings = ["render", "view", "query", "compare", "bench"];
    let command = Cli::command().args_override_self(true);
    with_settings.into_iter().fold(command, |command, name| {
        command.mut_subcommand(name, |sub| sub.mut_args(|arg| describe_setting(lenient(arg))))
    })
}

/// Lets values begin with a minus, so that the error is about the value and its range.
fn lenient(arg: clap::Arg) -> clap::Arg {
    let has_value =
        arg.get_long().is_some() && arg.get_action().takes_values() && !arg.is_require_equals_set();
    let is_list =
        arg.get_value_names().is_some_and(|names| names.iter().any(|name| name.contains([',', 'x'])));
    arg.allow_negative_numbers(has_value && !is_list).allow_hyphen_values(has_value && is_list)
}

/// Adds its default to the help of a setting, and says what values are expected.
fn describe_setting(arg: clap::Arg) -> clap::Arg {
    let Some(field) = arg.get_long().and_then(Settings::field) else { return arg };
    let default = Settings::default().get(field.name).expect("every field has a value");
    let arg = arg.help(format!("{} [default: {default}]", field.doc));
    match field.kind {
        Kind::Whole => {
            let (least, most) = if field.name == "spp" { (1, 65536) } else { (0, u32::MAX) };
            // Numbers out of range pass here: the check of all settings tells them together.
            arg.value_parser(move |text: &str| whole(text, 0, u32::MAX).or_else(|_| whole(text, least, most)))
        }
        Kind::Number => arg.value_parser(read::<f32>),
        Kind::AutoNumber => arg.value_parser(read::<Auto<f32>>),
        Kind::Size => arg.value_parser(read::<Size>),
        Kind::Rgb => arg.value_parser(read::<Rgb>),
        Kind::AutoRgb => arg.value_parser(read::<Auto<Rgb>>),
        Kind::AutoTriple => arg.value_parser(read::<Auto<Triple>>),
        Kind::AutoRange => arg.value_parser(read::<Auto<Range>>),
        Kind::Flag | Kind::Choice(_) | Kind::AutoText => arg, // as clap reads them
    }
}

/// The value of a setting; the error says what is expected.
fn read<T: Value>(text: &str) -> Result<T, String> {
    T::read(text).map_err(|error| error.expected().to_owned())
}

/// Advice for a command line that names no command, such as `ambray scene.glb`.
#[must_use]
pub fn hint(arguments: &[OsString]) -> Option<String> {
    let first = arguments.get(1)?.to_str()?;
    let is_command = Cli::command().get_subcommands().any(|sub| sub.get_name() == first) || first == "help";
    (!is_command).then(|| format!("to render a scene: ambray render {first} ..."))
}

/// Parses `arguments`, the program's name first. Never exits and never panics, whatever they are.
///
/// Requests for help and the version are errors too, as clap has it; their exit code is 0.
pub fn parse_from<I, T>(arguments: I) -> Result<Command, clap::Error>
where
    I: IntoIterator<Item = T>,
    T: Into<OsString> + Clone,
{
    let parse = |matches: clap::ArgMatches| Cli::from_arg_matches(&matches).map(|cli| cli.command);
    if let Some(command) = parse(command().try_get_matches_from(arguments)?)? {
        return Ok(command);
    }
    let rendered = parse(command().try_get_matches_from(["ambray", "render"])?)?;
    Ok(rendered.expect("a command was named"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn command_is_consistent() {
        command().debug_assert();
    }

    #[test]
    fn no_arguments_render_the_atrium() {
        let Ok(Command::Render(args)) = parse_from(["ambray"]) else { panic!("expected render") };
        assert_eq!(args.scene.scene, PathBuf::from("atrium"));
        assert_eq!(args.output, None);
        assert_eq!(args.settings.flags, SettingsPatch::default());
    }

    #[test]
    fn a_missing_command_is_suggested() {
        let hint = |line: &[&str]| hint(&line.iter().map(OsString::from).collect::<Vec<_>>());
        assert_eq!(hint(&["ambray", "x.glb"]).as_deref(), Some("to render a scene: ambray render x.glb ..."));
        assert!(hint(&["ambray", "--spp=4"]).is_some());
        assert_eq!(hint(&["ambray", "query"]), None);
    }

    #[test]
    fn the_last_of_two_flags_counts() {
        let Ok(Command::Render(args)) = parse_from(["ambray", "render", "--spp=3", "-q", "--spp=5"]) else {
            panic!("expected render")
        };
        assert_eq!(args.settings.flags.spp, Some(5));
    }

    #[test]
    fn planes_are_listed() {
        let Ok(Command::Render(args)) = parse_from(["ambray", "render", "--aov", "depth,openness-raw"])
        else {
            panic!("expected render")
        };
        assert_eq!(args.aov, [Planes::One(Aov::Depth), Planes::One(Aov::OpennessRaw)]);
    }

    #[test]
    fn negative_values_reach_the_range_check() {
        for flag in ["radius", "exponent", "sun-strength", "filter-plane"] {
            let parsed = parse_from(["ambray", "render", &format!("--{flag}"), "-1"]);
            assert!(parsed.is_ok(), "{flag}: {}", parsed.unwrap_err());
        }
        for flag in ["ambient", "sun-color", "camera-position"] {
            let parsed = parse_from(["ambray", "render", &format!("--{flag}"), "-1,0,.5"]);
            assert!(parsed.is_ok(), "{flag}: {}", parsed.unwrap_err());
        }
    }

    #[test]
    fn help_tells_every_default() {
        let mut command = command();
        let render = command.find_subcommand_mut("render").expect("render is a command");
        let help = render.render_long_help().to_string();
        for field in Settings::fields() {
            assert!(help.contains(&format!("--{}", field.name)), "{} has no flag", field.name);
        }
        assert!(help.contains("[default: 1280x720]") && help.contains("[default: 0.01]"), "{help}");
    }
}
