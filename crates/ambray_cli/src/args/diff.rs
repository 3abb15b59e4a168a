//! Options of `ambray diff`.

use std::path::PathBuf;

use ambray::settings::{Ramp, Range};
use ambray_metrics::Measure;
use clap::{
    Args,
    builder::{PossibleValue, PossibleValuesParser, TypedValueParser},
};

/// Arguments of `ambray diff`.
#[derive(Clone, Debug, Args)]
pub struct DiffArgs {
    /// Picture to judge: PNG with 8 or 16 bits, or OpenEXR
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// Picture that it should be, of the same size
    #[arg(value_name = "REFERENCE")]
    pub reference: PathBuf,
    /// Compare these layers, separated by commas: beauty, openness, depth and so on in OpenEXR, picture in PNG [default: all,
    /// and both must have the same]
    #[arg(long, value_name = "LAYERS", value_delimiter = ',', conflicts_with = "common")]
    pub layer: Vec<String>,
    /// Compare the layers that both have, and leave out those that one has alone
    #[arg(long)]
    pub common: bool,
    /// What decides whether they agree
    #[arg(long, value_name = "MEASURE", default_value = Measure::Rmse.name(), value_parser = measures())]
    pub measure: Measure,
    /// The worst value of the measure that counts as agreement, in every layer; PSNR and SSIM need one [default: 0]
    #[arg(long, value_name = "VALUE", allow_negative_numbers = true, value_parser = finite)]
    pub tolerance: Option<f64>,
    /// Write the error of every pixel, the largest of its channels, to a PNG picture; of several layers, the others go to
    /// OUT-stem.LAYER.png
    #[arg(short, long, value_name = "OUT.png")]
    pub output: Option<PathBuf>,
    /// In the picture of errors, red where the picture is above the reference, blue where it is below, white where they agree
    #[arg(long)]
    pub signed: bool,
    /// Colours of the picture of errors
    #[arg(long, value_enum, value_name = "COLOURS", default_value = "magma")]
    pub ramp: Ramp,
    /// Errors at the ends of its colours [default: from 0 to the largest error of the layer]
    #[arg(long, value_name = "LOW,HIGH", allow_hyphen_values = true, value_parser = read_range)]
    pub range: Option<Range>,
    /// Print the measures as one JSON object on stdout
    #[arg(long)]
    pub json: bool,
    /// Print nothing: the exit code tells
    #[arg(short, long, conflicts_with = "json")]
    pub quiet: bool,
}

/// The measures of a pair.
fn measures() -> impl TypedValueParser<Value = Measure> {
    let pairs = Measure::ALL.iter().filter(|measure| !measure.needs_filter());
    PossibleValuesParser::new(pairs.map(|measure| PossibleValue::new(measure.name()).help(measure.meaning())))
        .try_map(|name| name.parse::<Measure>())
}

fn finite(text: &str) -> Result<f64, &'static str> {
    text.parse().ok().filter(|value: &f64| value.is_finite()).ok_or("a number")
}

fn read_range(text: &str) -> Result<Range, String> {
    let range = text.parse::<Range>().map_err(|error| error.expected().to_owned())?;
    let Range([low, high]) = range;
    let is_range = low.is_finite() && high.is_finite() && low < high;
    is_range.then_some(range).ok_or_else(|| "LOW,HIGH, such as 0,0.1, the smaller first".to_owned())
}
