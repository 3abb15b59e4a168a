//! Figure 1: openness, and colour bleeding off and on.

use ambray::{
    Aov, Frame, RenderError,
    settings::{NearRadiance, Settings},
};
use ambray_metrics::{Map, rmse};
use glam::{Vec3, Vec4Swizzles};

use super::{
    Figure, Studio, plain,
    shot::{measured, picture_of},
};
use crate::{
    document::{Block, Section},
    experiment::Spread,
    pictures,
    truth::Truth,
};

/// Times the price of openness alone that count as the same price.
const MOST_TIME: f64 = 1.1;

pub(super) fn figure(studio: &mut Studio<'_, '_>, view: &Settings) -> Result<Figure, RenderError> {
    let on = plain(view);
    let off = Settings { near_radiance: NearRadiance::Off, ..on.clone() };
    let truth = studio.truth(&on)?;
    let lit = studio.shoot("colour bleeding on", &on, &truth)?;
    let dark = studio.shoot("colour bleeding off", &off, &truth)?;
    let show =
        |name: &str, caption: &str, frame: &Frame, aov| pictures::shown(name, caption, frame, aov, &on);
    let [time_off, time_on] = times(studio, [&off, &on])?;
    let rays = |frame: &Frame| frame.stats.rays.ambient as f64 / frame.gbuffer.len() as f64;

    let composed = Block::Slider {
        caption: "The picture without and with colour bleeding.".to_owned(),
        pictures: vec![
            show("off", "Openness alone", &dark.frame, Aov::Beauty),
            show("on", "Openness and near radiance", &lit.frame, Aov::Beauty),
            show("truth", "The converged light", &truth.lit(&lit.frame), Aov::Beauty),
        ],
        left: 0,
        right: 1,
    };
    let planes = Block::Gallery {
        caption: "What it is made of.".to_owned(),
        pictures: vec![
            pictures::grey("openness", "Openness O", &lit.filtered),
            picture_of(&truth),
            show("near-radiance", "Near radiance I", &lit.frame, Aov::NearRadiance),
            show(
                "near-radiance-truth",
                "Near radiance of the truth",
                &truth.lit(&lit.frame),
                Aov::NearRadiance,
            ),
        ],
        columns: 2,
    };
    let errors = near_errors(&lit.frame, &truth);
    let without = near_errors(&dark.frame, &truth);
    let finding = Block::Finding {
        claim: "The hits of the ambient rays give colour bleeding at the price of openness alone.".to_owned(),
        measured: format!(
            "{:.2} rays a pixel without it, {:.2} with it; {:.2} times the time of the ambient pass (up to {MOST_TIME} counts as \
             the same price). Near radiance errs by {errors:.4} (RMSE over its channels), without it by {without:.4}.",
            rays(&dark.frame),
            rays(&lit.frame),
            time_on / time_off
        ),
        holds: time_on < MOST_TIME * time_off && errors < 0.5 * without,
    };
    let section = Section {
        title: "Figure 1: openness and colour bleeding".to_owned(),
        blocks: vec![
            Block::Text(
                "Rays that find how open a point is also find what colour its surroundings have. Where something coloured is \
                 near, its colour is seen on what is around it."
                    .to_owned(),
            ),
            composed,
            planes,
            finding,
        ],
    };
    Ok((section, vec![measured("1", "openness", lit.measures(&truth))]))
}

/// Median times of the ambient pass with each of `settings`, in turns, milliseconds.
fn times(studio: &mut Studio<'_, '_>, settings: [&Settings; 2]) -> Result<[f64; 2], RenderError> {
    let mut times = [Vec::new(), Vec::new()];
    for run in 0..=studio.options.runs {
        for (settings, times) in settings.iter().zip(&mut times) {
            let stats = studio.work.step("timing colour bleeding", settings.spp as f32, |control| {
                studio.renderer.measure(settings, control)
            })?;
            // The first one warms up.
            if run > 0 {
                times.push(stats.times.ambient.as_secs_f64() * 1e3);
            }
        }
    }
    Ok(times.map(|times| Spread::of(times).median))
}

/// Root mean square error of near radiance over its channels.
fn near_errors(frame: &Frame, truth: &Truth) -> f64 {
    let width = frame.width as usize;
    let channel = |near: &mut dyn Iterator<Item = Vec3>, axis: usize| Map {
        width,
        values: near.map(|near| near[axis]).collect(),
    };
    let square = |axis: usize| {
        let estimate = channel(&mut frame.ambient.iter().map(|value| value.yzw()), axis);
        let reference = channel(&mut truth.near.iter().copied(), axis);
        rmse(&estimate, &reference).powi(2)
    };
    ((square(0) + square(1) + square(2)) / 3.0).sqrt()
}
