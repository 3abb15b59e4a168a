//! Subjects over the frames of a scene that moves.

use ambray::{
    RenderError, Renderer,
    settings::{Auto, Method, Settings, Temporal},
};
use ambray_metrics::{Ghosting, flicker_of, ghosting, rmse};
use serde::Serialize;

use super::{Options, Work};
use crate::{
    maps,
    subject::Subject,
    truth::{AboutTruth, Content, Truth},
};

/// Change of the truth from one frame to the next from which on it counts as one, for [`ghosting`].
const CHANGED: f32 = 0.02;

/// Frames of a scene that moves.
#[derive(Clone, Debug)]
pub struct SequenceOptions {
    /// How many, from the time that the settings say on.
    pub frames: u32,
    /// Frames a second.
    pub fps: f64,
}

/// What was measured of a sequence.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Moving {
    /// Frames.
    pub frames: u32,
    /// Frames a second.
    pub fps: f64,
    /// How the truth of that frame was found which is the least certain.
    pub truth: AboutTruth,
    /// Every subject, and Ambray accumulating over the frames.
    pub rows: Vec<SequenceRow>,
}

/// What was measured of one subject over a sequence.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct SequenceRow {
    /// The name of the subject.
    pub name: String,
    /// Root mean square error of each frame.
    pub rmse: Vec<f64>,
    /// Root mean square change of the error from frame to frame.
    pub flicker: f64,
    /// How many frames later it is than the same rays without accumulation, where the truth changes. Nothing for methods that
    /// keep no frames, whose errors only look late or early; nor if the truth changes nowhere.
    pub lag: Option<f64>,
    /// Root mean square error where the truth changes.
    pub changing_rmse: Option<f64>,
}

/// Renders all `subjects` over the frames of `sequence`, and Ambray again with accumulation.
pub(super) fn run(
    renderer: &mut Renderer,
    content: &Content,
    settings: &Settings,
    options: &Options,
    sequence: &SequenceOptions,
    subjects: &[Subject],
    work: &Work<'_>,
) -> Result<Moving, RenderError> {
    let at = |settings: &Settings, k: u32| {
        let time = f64::from(settings.time.unwrap_or(0.0)) + f64::from(k) / sequence.fps;
        Settings { time: Auto::Value(time as f32), ..settings.clone() }
    };
    let (mut truths, mut about) = (Vec::new(), Vec::new());
    for k in 0..sequence.frames {
        let what = format!("the truth of frame {k}");
        let truth = work.step(&what, super::TRUTH_WEIGHT, |control| {
            Truth::find(renderer, content, &at(settings, k), &options.truth, control)
        })?;
        truths.push(truth.openness);
        about.push(truth.about);
    }
    let mut rows = Vec::<SequenceRow>::new();
    let mut ambray_alone = None;
    for subject in subjects.iter().cloned().chain([accumulating(settings)]) {
        renderer.forget_frames();
        let mut maps = Vec::new();
        for k in 0..sequence.frames {
            let mut settings = at(&subject.settings, k);
            if settings.temporal == Temporal::On {
                settings.frame = subject.settings.frame.wrapping_add(k);
            }
            let what = format!("{}, frame {k}", subject.name);
            let weight = settings.spp as f32 + 4.0;
            let frame = work.step(&what, weight, |control| renderer.render(&settings, control))?;
            maps.push(maps::filtered(&frame));
        }
        let ghosting = ghosting(&maps, &truths, CHANGED);
        let lag = ghosting.map(|Ghosting { lag, .. }| lag);
        if subject.settings.method == Method::Ambray && subject.settings.temporal == Temporal::Off {
            ambray_alone = lag;
        }
        let accumulates = subject.settings.temporal == Temporal::On;
        rows.push(SequenceRow {
            name: subject.name.clone(),
            rmse: maps.iter().zip(&truths).map(|(map, truth)| rmse(map, truth)).collect(),
            flicker: flicker_of(&maps, &truths).unwrap_or_default(),
            lag: lag.zip(ambray_alone).filter(|_| accumulates).map(|(lag, alone)| lag - alone),
            changing_rmse: ghosting.map(|Ghosting { rmse, .. }| rmse),
        });
    }
    let truth = AboutTruth::worst(&about).expect("a sequence has frames");
    Ok(Moving { frames: sequence.frames, fps: sequence.fps, truth, rows })
}

/// Ambray with light that accumulates over the frames.
fn accumulating(settings: &Settings) -> Subject {
    let settings = Settings { method: Method::Ambray, temporal: Temporal::On, ..settings.clone() };
    Subject { name: "Ambray, accumulated".to_owned(), settings }
}
