//! Figure 6: more and more rays.

use ambray::{RenderError, settings::Settings};

use super::{
    Figure, Studio, plain,
    shot::{measured, named, picture_of},
};
use crate::{
    document::{Axis, Block, Plot, Section, Series},
    pictures, report,
    subject::Effort,
};

/// Rays a pixel of the figure.
const RAYS: [u32; 6] = [1, 2, 4, 8, 16, 32];
/// Where the paper says that more rays do not visibly improve the picture.
const ENOUGH: usize = 3;

pub(super) fn figure(studio: &mut Studio<'_, '_>, view: &Settings) -> Result<Figure, RenderError> {
    let settings = plain(view);
    let truth = studio.truth(&settings)?;
    let (mut openness, mut all, mut maps) = (Vec::new(), Vec::new(), Vec::new());
    for spp in RAYS {
        let name = Effort::Rays(spp).to_string();
        let shot = studio.shoot(&name, &Settings { spp, ..settings.clone() }, &truth)?;
        openness.push(pictures::grey(&name, format!("{name}, filtered"), &shot.filtered));
        all.push(measured("6", &name, shot.measures(&truth)));
        maps.push(shot);
    }
    openness.push(picture_of(&truth));
    let (enough, most) = (all[ENOUGH].measures, all[RAYS.len() - 1].measures);
    let seen = ambray_metrics::flip(&maps[RAYS.len() - 1].filtered, &maps[ENOUGH].filtered);
    let blurred = ambray_metrics::flip(&truth.openness, &maps[ENOUGH].filtered_truth);
    let (sampling, loss) = (enough.sampling_part.unwrap_or_default(), enough.filter_loss.unwrap_or_default());
    let curve = |name: &str, value: &dyn Fn(usize) -> f64| Series {
        name: name.to_owned(),
        points: (0..RAYS.len()).map(|i| (f64::from(RAYS[i]), value(i))).collect(),
        labels: RAYS.iter().map(|&spp| Effort::Rays(spp).to_string()).collect(),
    };
    let plot = Plot {
        caption: "Error of openness against rays.".to_owned(),
        x: Axis { title: "rays a pixel".to_owned(), logarithmic: true },
        y: Axis { title: "root mean square error".to_owned(), logarithmic: true },
        series: vec![
            curve("after the filter", &|i| all[i].measures.rmse),
            curve("sampling part", &|i| all[i].measures.sampling_part.unwrap_or_default()),
            curve("filter loss", &|i| all[i].measures.filter_loss.unwrap_or_default()),
        ],
    };
    let section = Section {
        title: "Figure 6: rays a pixel".to_owned(),
        blocks: vec![
            Block::Slider {
                caption: "Openness after the filter.".to_owned(),
                pictures: openness,
                left: 0,
                right: 3,
            },
            Block::Plot(plot),
            Block::Finding {
                claim: "More than 8 rays a pixel do not visibly improve the picture.".to_owned(),
                measured: format!(
                    "FLIP between 8 and 32 rays is {seen:.4}; what the filter does to the truth has {blurred:.4} (less than that \
                     counts as invisible beside it). RMSE falls from {:.4} to {:.4}; at 8 rays the sampling part is \
                     {sampling:.4}, and what the filter blurs {loss:.4}.",
                    enough.rmse, most.rmse
                ),
                holds: seen < blurred,
            },
            Block::Table(report::measures_table("Errors of openness.".to_owned(), &named(&all))),
        ],
    };
    Ok((section, all))
}
