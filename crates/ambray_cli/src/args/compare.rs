//! Options of `ambray compare`.

use std::path::PathBuf;

use ambray::settings::Method;
use ambray_files::Rate;
use clap::Args;

use super::{BackendArgs, RunArgs, SceneArgs, SettingsArgs, whole};

const HEADING: &str = "Comparison";
/// Frames of a sequence: each needs a truth of its own.
const MOST_FRAMES: u32 = 10_000;

/// Arguments of `ambray compare`.
#[derive(Clone, Debug, Args)]
pub struct CompareArgs {
    /// The scene.
    #[command(flatten)]
    pub scene: SceneArgs,
    /// Report to write, a page that needs nothing else; beside it all numbers as .json, and those of still pictures as .csv
    #[arg(short, long, value_name = "REPORT.html", default_value = "compare.html")]
    pub output: PathBuf,
    /// Make the figures and the table of the paper instead, each with what was measured
    #[arg(long, help_heading = HEADING, conflicts_with_all = ["methods", "rays", "frames"])]
    pub paper: bool,
    /// Which methods, separated by commas [default: all]
    #[arg(long, value_name = "METHODS", help_heading = HEADING, value_enum, value_delimiter = ',')]
    pub methods: Vec<Method>,
    /// Rays a pixel of the plots, separated by commas
    #[arg(
        long, value_name = "N,...", help_heading = HEADING, value_delimiter = ',', default_value = "1,2,4,8,16,32",
        value_parser = |text: &str| whole::<u32>(text, 1, 4096)
    )]
    pub rays: Vec<u32>,
    /// Frames that are timed of each method, and a third as many of each point of the plots
    #[arg(
        long, value_name = "N", help_heading = HEADING, default_value_t = 9,
        value_parser = |text: &str| whole::<u32>(text, 1, 100_000)
    )]
    pub runs: u32,
    /// Compare this many frames of an animation too: flicker, and how late accumulated light is
    #[arg(
        long, value_name = "COUNT", help_heading = HEADING,
        value_parser = |text: &str| whole::<u32>(text, 2, MOST_FRAMES)
    )]
    pub frames: Option<u32>,
    /// Frames a second of these, a number or a fraction such as 30000/1001 [default: 30]
    #[arg(long, value_name = "RATE", help_heading = HEADING)]
    pub fps: Option<Rate>,
    /// Standard error of the truth: rays are added until it is below, root mean square over the pixels that see a surface
    #[arg(long, value_name = "ERROR", help_heading = HEADING, default_value_t = 0.002, value_parser = error)]
    pub truth_error: f64,
    /// Rays a pixel after which the truth has to do
    #[arg(
        long, value_name = "RAYS", help_heading = HEADING, default_value_t = 16_384,
        value_parser = |text: &str| whole::<u32>(text, 1024, 1 << 20)
    )]
    pub truth_spp: u32,
    /// Folder where truths are kept for the next time [default: truths in the user's folder for caches]
    #[arg(long, value_name = "FOLDER", help_heading = HEADING, conflicts_with = "no_cache")]
    pub cache: Option<PathBuf>,
    /// Find the truth anew, and keep nothing
    #[arg(long, help_heading = HEADING)]
    pub no_cache: bool,
    /// Print the numbers as one JSON object on stdout
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

fn error(text: &str) -> Result<f64, String> {
    let bound = text.parse().ok().filter(|error| (1e-5..=1.0).contains(error));
    bound.ok_or_else(|| "a number from 0.00001 to 1".to_owned())
}
