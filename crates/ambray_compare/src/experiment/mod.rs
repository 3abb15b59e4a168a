//! Subjects measured against the truth of a view.

mod row;
mod sequence;
mod spread;
mod work;

use ambray::{
    Aov, Frame, RenderError, Renderer,
    settings::{Method, NearRadiance, Settings},
};
use ambray_metrics::Map;
use serde::Serialize;

pub use row::{Row, Who};
pub use sequence::{Moving, SequenceOptions, SequenceRow};
pub use spread::Spread;
pub use work::Work;

use crate::{
    document::Picture,
    maps, pictures,
    subject::{About, Subject},
    truth::{AboutTruth, Content, Truth, TruthOptions},
};

/// Signed errors that error maps show in full colour.
pub const ERROR_SCALE: f32 = 0.2;

/// What is measured, and how well.
#[derive(Clone, Debug)]
pub struct Options {
    /// Which methods; Ambray itself is always among them.
    pub methods: Vec<Method>,
    /// Rays a pixel of the plots.
    pub rays: Vec<u32>,
    /// Frames that are timed of each subject, after one that is not.
    pub runs: u32,
    /// The truth.
    pub truth: TruthOptions,
    /// A sequence, for scenes that move.
    pub sequence: Option<SequenceOptions>,
}

/// Everything that was measured of a view.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Outcome {
    /// How the truth was found.
    pub truth: AboutTruth,
    /// Mean openness of the truth.
    pub mean_openness: f64,
    /// Near-field radius, scene units.
    pub radius: f32,
    /// Where the camera came from.
    pub camera: String,
    /// Every subject with the settings that were asked for.
    pub rows: Vec<Row>,
    /// Every subject with more and less effort, the subject of a row with all its efforts in order.
    pub series: Vec<Vec<Row>>,
    /// The sequence, if one was asked for.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub sequence: Option<Moving>,
    /// What is to be seen.
    #[serde(skip)]
    pub seen: Seen,
}

/// Pictures of a view: the truth first, then every subject in the order of the rows.
#[derive(Clone, Debug, Default)]
pub struct Seen {
    /// Filtered openness.
    pub openness: Vec<Picture>,
    /// Openness before the filter.
    pub raw: Vec<Picture>,
    /// Signed error of filtered openness, without the truth.
    pub errors: Vec<Picture>,
    /// The composed picture.
    pub beauty: Vec<Picture>,
}

/// Measures what `renderer` shows with `settings`. `content` is of its scene as it was opened.
///
/// # Errors
/// As [`Renderer::render`].
pub fn run(
    renderer: &mut Renderer,
    content: &Content,
    settings: &Settings,
    options: &Options,
    mut work: Work<'_>,
) -> Result<Outcome, RenderError> {
    let subjects = subjects(settings, options);
    let efforts: Vec<Vec<Subject>> = subjects
        .iter()
        .map(|subject| {
            subject.efforts(&options.rays).into_iter().map(|effort| subject.with(effort)).collect()
        })
        .collect();
    // Before the work rather than after most of it.
    for subject in subjects.iter().chain(efforts.iter().flatten()) {
        let errors = subject.settings.validate();
        if !errors.is_empty() {
            return Err(RenderError::Settings(errors));
        }
    }
    work.expect(weight(&subjects, options));
    let mut find = |settings: &Settings| {
        work.step("finding the truth", TRUTH_WEIGHT, |control| {
            Truth::find(renderer, content, settings, &options.truth, control)
        })
    };
    let truth = find(settings)?;
    let step = subjects.iter().find(|subject| subject.settings.method == Method::TracedStep);
    let step = step.map(|subject| find(&subject.settings)).transpose()?;
    let mut bench = Bench { renderer, truth: &truth, step: step.as_ref().unwrap_or(&truth), work: &work };

    let mut seen = Seen::default();
    let mut rows = Vec::new();
    let mut view = None;
    for subject in &subjects {
        let (row, frame, filtered) = bench.measure(subject)?;
        if rows.is_empty() {
            seen.add_truth(&truth, &frame, settings);
            view = Some(frame.view.clone());
        }
        seen.add(subject, &row, &frame, &filtered, &truth);
        rows.push(row);
    }
    bench.time(&subjects, &mut rows, options.runs)?;
    let mut points = Vec::new();
    for subject in efforts.iter().flatten() {
        points.push(bench.measure(subject)?.0);
    }
    bench.time(&efforts.concat(), &mut points, options.runs.div_ceil(3))?;
    let mut points = points.into_iter();
    let series = efforts.iter().map(|line| points.by_ref().take(line.len()).collect()).collect();
    let view = view.expect("Ambray itself is always a subject");
    let sequence = match &options.sequence {
        Some(sequence) => {
            Some(sequence::run(renderer, content, settings, options, sequence, &subjects, &work)?)
        }
        None => None,
    };
    Ok(Outcome {
        truth: truth.about,
        mean_openness: truth.openness.mean(),
        radius: view.radius,
        camera: view.camera_origin,
        rows,
        series,
        sequence,
        seen,
    })
}

/// The weight of a truth among frames of one ray: a guess, for the progress bar.
pub(crate) const TRUTH_WEIGHT: f32 = 1024.0;

fn weight(subjects: &[Subject], options: &Options) -> f32 {
    let one = |subject: &Subject, runs: u32| (subject.settings.spp as f32 + 4.0) * (2 + runs) as f32;
    let series = |subject: &Subject| {
        let efforts = subject.efforts(&options.rays).into_iter();
        efforts.map(|effort| one(&subject.with(effort), options.runs.div_ceil(3))).sum::<f32>()
    };
    let still: f32 = subjects.iter().map(|subject| one(subject, options.runs) + series(subject)).sum();
    let step = subjects.iter().any(|subject| subject.settings.method == Method::TracedStep);
    let truths = if step { 2.0 * TRUTH_WEIGHT } else { TRUTH_WEIGHT };
    // Ambray comes twice in sequences.
    let frame: f32 = subjects.iter().chain(&subjects[..1]).map(|subject| one(subject, 0)).sum();
    let frames = options.sequence.as_ref().map_or(0, |sequence| sequence.frames);
    truths + still + (TRUTH_WEIGHT + frame) * frames as f32
}

/// The methods that are asked for, each once, Ambray first.
fn subjects(settings: &Settings, options: &Options) -> Vec<Subject> {
    let asked = |method: &&Method| **method == Method::Ambray || options.methods.contains(method);
    Method::ALL.iter().filter(asked).map(|&method| Subject::of(method, settings)).collect()
}

/// What subjects are measured with.
struct Bench<'a, 'b> {
    renderer: &'a mut Renderer,
    truth: &'a Truth,
    /// What a step converges to.
    step: &'a Truth,
    work: &'a Work<'b>,
}

impl Bench<'_, '_> {
    /// Renders `subject` once: its errors, the frame, and its filtered openness.
    fn measure(&mut self, subject: &Subject) -> Result<(Row, Frame, Map), RenderError> {
        let Subject { name, settings } = subject;
        let what = format!("{name}, {}", subject.effort());
        let weight = settings.spp as f32 + 4.0;
        self.work.step(&what, weight, |control| {
            self.renderer.forget_frames();
            let frame = self.renderer.render(settings, control)?;
            let settings = settings.by_method();
            let own = if subject.settings.method == Method::TracedStep { self.step } else { self.truth };
            let filtered_own = maps::filter(&own.openness, &frame, &settings, control)?;
            let filtered = maps::filtered(&frame);
            let who = Who::of(&self.renderer.machine_for(&settings));
            let row = Row::new(
                subject,
                &frame,
                (&filtered, &self.truth.openness),
                (&own.openness, &filtered_own),
                who,
            );
            Ok((row, frame, filtered))
        })
    }

    /// Times frames of all `subjects` in turn, so that what disturbs the machine disturbs all alike.
    fn time(&mut self, subjects: &[Subject], rows: &mut [Row], runs: u32) -> Result<(), RenderError> {
        let mut times = vec![Vec::new(); subjects.len()];
        for run in 0..=runs {
            for (subject, times) in subjects.iter().zip(&mut times) {
                let what = format!("timing {}, {}", subject.name, subject.effort());
                let weight = subject.settings.spp as f32 + 4.0;
                // What others do not have is not timed.
                let settings = Settings { near_radiance: NearRadiance::Off, ..subject.settings.clone() };
                let measured = self.work.step(&what, weight, |control| {
                    self.renderer.forget_frames();
                    self.renderer.measure(&settings, control)
                });
                let taken = measured?.times;
                // The first one warms up.
                if run > 0 {
                    times.push((taken.ambient + taken.filter).as_secs_f64() * 1e3);
                }
            }
        }
        for (row, times) in rows.iter_mut().zip(times) {
            row.milliseconds = Spread::of(times);
        }
        Ok(())
    }
}

impl Seen {
    fn add_truth(&mut self, truth: &Truth, frame: &Frame, settings: &Settings) {
        let caption = format!("{} rays a pixel, no filter", truth.about.spp);
        self.openness.push(pictures::grey("Truth", &caption, &truth.openness));
        self.beauty.push(pictures::shown("Truth", &caption, &truth.lit(frame), Aov::Beauty, settings));
    }

    fn add(&mut self, subject: &Subject, row: &Row, frame: &Frame, filtered: &Map, truth: &Truth) {
        let Subject { name, settings } = subject;
        let measures = &row.measures;
        let caption = format!(
            "{} RMSE {:.4}, bias {:+.4}.",
            About::of(settings.method).text,
            measures.rmse,
            measures.bias
        );
        self.openness.push(pictures::grey(name, &caption, filtered));
        self.raw.push(pictures::grey(
            name,
            format!("{}, before the filter", subject.effort()),
            &maps::raw(frame),
        ));
        self.errors.push(pictures::error(name, &caption, filtered, &truth.openness, ERROR_SCALE));
        self.beauty.push(pictures::shown(name, &caption, frame, Aov::Beauty, settings));
    }
}

#[cfg(test)]
mod tests;
