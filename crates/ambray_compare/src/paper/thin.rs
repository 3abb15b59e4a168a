//! Figures 3 and 5: thin objects.

use ambray::{
    RenderError,
    settings::{Settings, Thin},
};

use super::{
    Figure, Studio, plain,
    shot::{measured, named, picture_of},
};
use crate::{
    document::{Block, Section},
    experiment::ERROR_SCALE,
    pictures, report,
};

const KINDS: [(Thin, &str, &str); 3] = [
    (Thin::Off, "thin off", "First rays only"),
    (Thin::Paper, "thin paper", "The paper's second batch: all pairs of missed rays"),
    (Thin::Sheet, "thin sheet", "Opposite pairs with fuzzy visibility"),
];

pub(super) fn figure(studio: &mut Studio<'_, '_>, view: &Settings) -> Result<Figure, RenderError> {
    let settings = plain(view);
    let truth = studio.truth(&settings)?;
    let (mut openness, mut errors, mut all, mut chords) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (thin, name, caption) in KINDS {
        let shot = studio.shoot(name, &Settings { thin, ..settings.clone() }, &truth)?;
        openness.push(pictures::grey(name, caption, &shot.filtered));
        errors.push(pictures::error(name, caption, &shot.filtered, &truth.openness, ERROR_SCALE));
        all.push(measured("3, 5", name, shot.measures(&truth)));
        chords.push(shot.frame.stats.rays.chord as f64 / shot.filtered.values.len() as f64);
    }
    openness.push(picture_of(&truth));
    let [off, paper, sheet] = [0, 1, 2].map(|i| all[i].measures);
    let section = Section {
        title: "Figures 3 and 5: thin objects".to_owned(),
        blocks: vec![
            Block::Text(
                "Where a sheet hangs just above the floor, most rays pass beside it, and the floor under its hem stays bright. A \
                 second batch joins the ends of the rays that missed. The bright line is correct all the same: a sheet without \
                 thickness, seen edge-on, hides nothing. To fill it is a look."
                    .to_owned(),
            ),
            Block::Slider { caption: "Openness.".to_owned(), pictures: openness, left: 0, right: 1 },
            Block::Gallery {
                caption: format!(
                    "Error: blue is too dark, red too bright; full colour is an error of {ERROR_SCALE}."
                ),
                pictures: errors,
                columns: 3,
            },
            Block::Text(format!(
                "Mean openness falls by {:.4} with the paper's batch and by {:.4} with the sheet, for {:.1} and {:.1} chords a \
                 pixel. RMSE with the sheet is {:.4}.",
                off.bias - paper.bias,
                off.bias - sheet.bias,
                chords[1],
                chords[2],
                sheet.rmse
            )),
            Block::Finding {
                claim: "The picture is nearer to the truth with the paper's second batch.".to_owned(),
                measured: format!(
                    "RMSE {:.4} without it, {:.4} with it (bias {:+.4} and {:+.4}).",
                    off.rmse, paper.rmse, off.bias, paper.bias
                ),
                holds: paper.rmse < off.rmse,
            },
            Block::Table(report::measures_table("Errors of openness.".to_owned(), &named(&all))),
        ],
    };
    Ok((section, all))
}
