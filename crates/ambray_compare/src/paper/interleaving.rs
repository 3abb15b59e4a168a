//! Figure 2: one sample set for all pixels, interleaved sets, and the filter.

use ambray::{
    RenderError,
    settings::{Sampling, Settings, Window},
};
use ambray_metrics::{edges, pattern_left, rmse};

use super::{
    Figure, Studio, plain,
    shot::{measured, named, picture_of},
};
use crate::{
    document::{Block, Section},
    pictures, report,
};

/// Power of the pattern over that around it below which it counts as removed (spec §11).
const PATTERN_BAR: f64 = 40.0;

pub(super) fn figure(studio: &mut Studio<'_, '_>, view: &Settings) -> Result<Figure, RenderError> {
    let settings = plain(view);
    let truth = studio.truth(&settings)?;
    let interleaved = studio.shoot("interleaved sets", &settings, &truth)?;
    let same = Settings { sampling: Sampling::Same, filter: Window::Off, ..settings.clone() };
    let same = studio.shoot("one set", &same, &truth)?;
    let unfiltered = ambray_metrics::Measures::of(&interleaved.raw, &truth.openness);
    let all = vec![
        measured("2", "one set for all pixels", ambray_metrics::Measures::of(&same.raw, &truth.openness)),
        measured("2", "interleaved, before the filter", unfiltered),
        measured("2", "interleaved, filtered", interleaved.measures(&truth)),
    ];
    let edges = edges(&truth.openness);
    let before = pattern_left(&interleaved.raw, &truth.openness, &edges);
    let after = pattern_left(&interleaved.filtered, &interleaved.filtered_truth, &edges);
    let (raw, filtered) =
        (rmse(&interleaved.raw, &truth.openness), rmse(&interleaved.filtered, &truth.openness));
    let spp = settings.spp;
    let section = Section {
        title: "Figure 2: interleaved sampling".to_owned(),
        blocks: vec![
            Block::Text(format!(
                "{spp} rays a pixel. One set of directions for all pixels turns the error into bands; 16 sets that interleave turn \
                 it into a pattern of 4 × 4 pixels; a filter of that size removes it."
            )),
            Block::Slider {
                caption: "Openness.".to_owned(),
                pictures: vec![
                    pictures::grey("one-set", "One set for all pixels, no filter", &same.raw),
                    pictures::grey("interleaved", "Interleaved sets, before the filter", &interleaved.raw),
                    pictures::grey("filtered", "Interleaved sets, after the filter", &interleaved.filtered),
                    picture_of(&truth),
                ],
                left: 0,
                right: 2,
            },
            Block::Finding {
                claim: "The filter removes the pattern of the interleaved sets.".to_owned(),
                measured: format!(
                    "Power at the frequencies of the pattern over that around them: {before:.0} before the filter, {after:.0} after \
                     it; rejected neighbours at edges keep a little. RMSE {raw:.4} before, {filtered:.4} after."
                ),
                holds: before > PATTERN_BAR && after < PATTERN_BAR,
            },
            Block::Table(report::measures_table("Errors of openness.".to_owned(), &named(&all))),
        ],
    };
    Ok((section, all))
}
