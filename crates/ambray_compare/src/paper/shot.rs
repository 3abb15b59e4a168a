//! Pictures of figures with their errors.

use std::sync::Arc;

use ambray::{Frame, RenderError, settings::Settings};
use ambray_metrics::{Map, Measures};

use super::{Measured, Studio};
use crate::{document::Picture, experiment::TRUTH_WEIGHT, maps, pictures, truth::Truth};

/// A rendered frame beside its truth.
pub(super) struct Shot {
    pub(super) frame: Frame,
    pub(super) raw: Map,
    pub(super) filtered: Map,
    /// The truth after the filter of the frame.
    pub(super) filtered_truth: Map,
}

impl Studio<'_, '_> {
    /// The truth of a view. Figures of the same view share it.
    pub(super) fn truth(&mut self, settings: &Settings) -> Result<Arc<Truth>, RenderError> {
        if let Some((_, truth)) = self.truths.iter().find(|(known, _)| known == settings) {
            return Ok(Arc::clone(truth));
        }
        let truth = self.work.step("finding the truth", TRUTH_WEIGHT, |control| {
            Truth::find(self.renderer, self.content, settings, &self.options.truth, control)
        })?;
        let truth = Arc::new(truth);
        self.truths.push((settings.clone(), Arc::clone(&truth)));
        Ok(truth)
    }

    /// A frame with `settings`, beside `truth`.
    pub(super) fn shoot(
        &mut self,
        what: &str,
        settings: &Settings,
        truth: &Truth,
    ) -> Result<Shot, RenderError> {
        self.work.step(what, settings.spp as f32, |control| {
            let frame = self.renderer.render(settings, control)?;
            let filtered_truth = maps::filter(&truth.openness, &frame, settings, control)?;
            Ok(Shot { raw: maps::raw(&frame), filtered: maps::filtered(&frame), frame, filtered_truth })
        })
    }
}

impl Shot {
    /// Errors of filtered openness.
    pub(super) fn measures(&self, truth: &Truth) -> Measures {
        Measures::of_filtered(&self.filtered, &truth.openness, &self.filtered_truth)
    }
}

/// Openness of the truth.
pub(super) fn picture_of(truth: &Truth) -> Picture {
    pictures::grey("truth", format!("{} rays a pixel, no filter", truth.about.spp), &truth.openness)
}

/// What was measured of a picture of `figure`.
pub(super) fn measured(figure: &str, name: &str, measures: Measures) -> Measured {
    Measured { figure: figure.to_owned(), name: name.to_owned(), measures }
}

/// Names and measures for a table.
pub(super) fn named(measured: &[Measured]) -> Vec<(String, Measures)> {
    measured.iter().map(|one| (one.name.clone(), one.measures)).collect()
}
