//! `ambray compare --paper`: the figures and the table of the paper, made again and measured.

mod bleeding;
mod interleaving;
mod rays;
mod shot;
mod table;
mod thin;
mod views;

use std::sync::Arc;

use ambray::{
    RenderError, Renderer,
    settings::{Settings, Size},
};
use ambray_metrics::Measures;
use serde::Serialize;

pub use views::Views;

use crate::{
    document::{Document, Section},
    experiment::{Spread, TRUTH_WEIGHT, Work},
    report,
    truth::{AboutTruth, Content, Truth, TruthOptions},
};

/// What the figures are made with.
#[derive(Clone, Debug)]
pub struct PaperOptions {
    /// The truth.
    pub truth: TruthOptions,
    /// Frames that are timed, after one that is not.
    pub runs: u32,
    /// Size of the frames of the table; the paper's is [`TABLE_SIZE`].
    pub table_size: Size,
}

/// Size of the frames of the paper's table.
pub const TABLE_SIZE: Size = Size { width: 1920, height: 1080 };

/// What was measured for the figures and the table.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Paper {
    /// How the truth of that view was found which is the least certain.
    pub truth: AboutTruth,
    /// Errors of every picture of the figures that shows openness.
    pub pictures: Vec<Measured>,
    /// Times of the passes.
    pub times: Vec<Times>,
}

/// Errors of a picture of a figure.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Measured {
    /// Which figure, such as `2`.
    pub figure: String,
    /// What is seen.
    pub name: String,
    /// Its errors against the truth of the view.
    #[serde(flatten)]
    pub measures: Measures,
}

/// Times of the passes of a frame, milliseconds.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Times {
    /// Kind of thin detection.
    pub thin: String,
    /// Primary rays and surfaces.
    pub primary: Spread,
    /// Direct light.
    pub direct: Spread,
    /// Ambient rays, chords included.
    pub ambient: Spread,
    /// Filter and composition.
    pub filter: Spread,
    /// The frame.
    pub total: Spread,
    /// Ambient rays a pixel, without chords.
    pub rays_per_pixel: f64,
    /// Chords a pixel.
    pub chords_per_pixel: f64,
}

/// A figure, or the table, with what was measured for it.
type Figure = (Section, Vec<Measured>);

/// What every figure is made with.
struct Studio<'a, 'b> {
    renderer: &'a mut Renderer,
    content: &'a Content,
    options: &'a PaperOptions,
    work: &'a Work<'b>,
    /// Truths of the views so far.
    truths: Vec<(Settings, Arc<Truth>)>,
}

/// Makes the figures and the table in the `views` that show what they are about.
///
/// # Errors
/// As [`Renderer::render`].
pub fn run(
    renderer: &mut Renderer,
    content: &Content,
    views: &Views,
    options: &PaperOptions,
    mut work: Work<'_>,
) -> Result<(Document, Paper), RenderError> {
    work.expect(2.0 * TRUTH_WEIGHT + table::WEIGHT * options.runs as f32);
    let mut studio = Studio { renderer, content, options, work: &work, truths: Vec::new() };
    let figures = [
        bleeding::figure(&mut studio, &views.bleeding)?,
        interleaving::figure(&mut studio, &views.overview)?,
        thin::figure(&mut studio, &views.thin)?,
        rays::figure(&mut studio, &views.overview)?,
    ];
    let (table, times) = table::table(&mut studio, &views.overview)?;
    let about: Vec<_> = studio.truths.iter().map(|(_, truth)| truth.about).collect();
    let truth = AboutTruth::worst(&about).expect("every figure has a truth");
    let mut sections = Vec::new();
    let mut pictures = Vec::new();
    for (section, measured) in figures {
        sections.push(section);
        pictures.extend(measured);
    }
    sections.push(table);
    let document = Document {
        title: "The paper's figures, made again".to_owned(),
        summary: "The figures of Fridvalszky and Tóth, Real-time ambient lighting with raytracing, rendered anew and measured \
                  against converged references; where a claim of the paper does not hold here, it says so."
            .to_owned(),
        facts: vec![
            ("views".to_owned(), views.origin.clone()),
            ("truth of the worst view".to_owned(), report::truth_in_words(&truth)),
        ],
        sections,
    };
    Ok((document, Paper { truth, pictures, times }))
}

/// The settings that the figures choose themselves, among those that differ from their default.
#[must_use]
pub fn chosen(settings: &Settings) -> Vec<&'static str> {
    let plain = plain(settings);
    let names = Settings::fields().iter().map(|field| field.name);
    names.filter(|name| settings.get(name) != plain.get(name)).collect()
}

/// Settings of a figure without what other figures are about.
fn plain(settings: &Settings) -> Settings {
    let defaults = Settings::default();
    Settings {
        method: defaults.method,
        screen_quality: defaults.screen_quality,
        thickness: defaults.thickness,
        thin_edge: defaults.thin_edge,
        thin_minimum: defaults.thin_minimum,
        sequence: defaults.sequence,
        thin: defaults.thin,
        temporal: defaults.temporal,
        sampling: defaults.sampling,
        filter: defaults.filter,
        near_radiance: defaults.near_radiance,
        ..settings.clone()
    }
}

#[cfg(test)]
mod tests;
