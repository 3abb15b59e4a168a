//! What was measured of one subject.

use ambray::{Frame, Machine, settings::Method};
use ambray_metrics::{Map, Measures, edges, grain, pattern_left, rmse};
use serde::Serialize;

use super::Spread;
use crate::{
    maps,
    subject::{Effort, Subject},
};

/// What was measured of one subject with one effort.
#[derive(Clone, Debug, Serialize)]
#[serde(rename_all = "kebab-case")]
pub struct Row {
    /// The name of the subject.
    pub name: String,
    /// Its method.
    pub method: Method,
    /// How much it does.
    pub effort: Effort,
    /// Ambient rays a pixel that were traced, chords included.
    pub rays_per_pixel: f64,
    /// Time of the method and its filter, without primary rays and direct light, milliseconds.
    pub milliseconds: Spread,
    /// Who computed it.
    pub who: Who,
    /// Mean openness.
    pub mean_openness: f64,
    /// Root mean square error before the filter.
    pub raw_rmse: f64,
    /// Root mean square error after the line through the estimate that fits the truth best.
    pub fitted_rmse: f64,
    /// Errors after the filter.
    pub measures: Measures,
}

/// Who computes a picture.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum Who {
    /// The processor, with kernels of this instruction set.
    Cpu(String),
    /// The Vulkan device of this name.
    Vulkan(String),
}

impl Who {
    /// Who `machine` is.
    #[must_use]
    pub fn of(machine: &Machine) -> Self {
        match machine {
            Machine::Cpu { isa, .. } => Self::Cpu((*isa).to_owned()),
            Machine::Vulkan { device, .. } => Self::Vulkan(device.clone()),
        }
    }
}

impl std::fmt::Display for Who {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Cpu(isa) => write!(f, "processor, {isa}"),
            Self::Vulkan(device) => f.write_str(device),
        }
    }
}

impl Row {
    /// Errors of `subject`, whose `filtered` openness stands before `truth`. `own` is what it converges to before and after its
    /// filter. It is not timed yet.
    pub(super) fn new(
        subject: &Subject,
        frame: &Frame,
        (filtered, truth): (&Map, &Map),
        own: (&Map, &Map),
        who: Who,
    ) -> Self {
        let rays = frame.stats.rays.ambient + frame.stats.rays.chord;
        Self {
            name: subject.name.clone(),
            method: subject.settings.method,
            effort: subject.effort(),
            rays_per_pixel: rays as f64 / filtered.values.len() as f64,
            milliseconds: Spread::default(),
            who,
            mean_openness: filtered.mean(),
            raw_rmse: rmse(&maps::shown_raw(frame), truth),
            fitted_rmse: maps::fitted_rmse(filtered, truth),
            measures: measures(subject.settings.method, (filtered, truth), own),
        }
    }
}

/// Errors of `filtered` against `truth`, and those that tell few rays from the filter, against what the method converges to by
/// itself. Methods in screen space do not converge to anything that is known: for them the latter would be mostly bias.
fn measures(method: Method, (filtered, truth): (&Map, &Map), (own, filtered_own): (&Map, &Map)) -> Measures {
    let measures = Measures { filter_loss: Some(rmse(filtered_own, own)), ..Measures::of(filtered, truth) };
    if method.is_screen_space() && method != Method::Hybrid {
        return measures;
    }
    Measures {
        sampling_part: Some(rmse(filtered, filtered_own)),
        grain: Some(grain(filtered, filtered_own)),
        pattern_left: Some(pattern_left(filtered, filtered_own, &edges(own))),
        ..measures
    }
}
