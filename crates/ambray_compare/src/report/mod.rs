//! The report of `ambray compare`: what was measured, as a document.

mod findings;
mod plots;
mod tables;

use ambray::settings::Method;

use crate::{
    document::{Block, Document, Section},
    experiment::{ERROR_SCALE, Outcome},
    subject::About,
    truth::AboutTruth,
};

pub use tables::{measures_table, number};

/// The document of an `outcome`, with `facts` about scene, settings and machine, and the `command` that made it.
#[must_use]
pub fn document(title: String, outcome: &Outcome, facts: Vec<(String, String)>, command: String) -> Document {
    let mut sections =
        vec![summary(outcome), pictures(outcome), light(outcome), rays(outcome), times(outcome)];
    sections.extend(outcome.sequence.as_ref().map(moving));
    sections.push(methods(outcome));
    sections.push(how(outcome, command));
    let mut all = facts;
    all.push(("truth".to_owned(), truth_in_words(&outcome.truth)));
    all.push(("radius R".to_owned(), format!("{} scene units", outcome.radius)));
    all.push(("camera".to_owned(), outcome.camera.clone()));
    Document {
        title,
        summary: "Openness (1 = open) by each method, for the same camera and the same surfaces, against the converged truth."
            .to_owned(),
        facts: all,
        sections,
    }
}

/// How the truth was found, in words.
#[must_use]
pub fn truth_in_words(truth: &AboutTruth) -> String {
    let AboutTruth { spp, standard_error, bound, cached, .. } = truth;
    let from = if *cached { ", kept from before" } else { "" };
    let reached = if truth.is_reached() { "below the bound of" } else { "NOT below the bound of" };
    format!("{spp} rays a pixel, standard error {standard_error:.5} ({reached} {bound}){from}")
}

fn section(title: &str, blocks: Vec<Block>) -> Section {
    Section { title: title.to_owned(), blocks }
}

fn summary(outcome: &Outcome) -> Section {
    let mut blocks: Vec<Block> = findings::of(outcome);
    blocks.push(Block::Table(tables::rows(&outcome.rows)));
    section("Summary", blocks)
}

fn pictures(outcome: &Outcome) -> Section {
    let seen = &outcome.seen;
    let slider = Block::Slider {
        caption: "Openness after the filter of each method.".to_owned(),
        pictures: seen.openness.clone(),
        left: 1,
        right: 0,
    };
    let raw = Block::Slider {
        caption: "Openness before the filter.".to_owned(),
        pictures: seen.raw.clone(),
        left: 0,
        right: usize::from(seen.raw.len() > 1),
    };
    let errors = Block::Gallery {
        caption: format!(
            "Error: blue is too dark, red too bright; full colour is an error of {ERROR_SCALE}. The mean of the truth is {:.4}.",
            outcome.mean_openness
        ),
        pictures: seen.errors.clone(),
        columns: 3,
    };
    section("Openness", vec![slider, raw, errors])
}

fn light(outcome: &Outcome) -> Section {
    let text = "The picture that follows: albedo times (ambient light times openness plus near radiance) plus direct light. \
                Methods in screen space have no near radiance: what is near does not colour its surroundings.";
    let slider = Block::Slider {
        caption: "The composed picture.".to_owned(),
        pictures: outcome.seen.beauty.clone(),
        left: 1,
        right: 0,
    };
    section("Light", vec![Block::Text(text.to_owned()), slider])
}

fn rays(outcome: &Outcome) -> Section {
    let text = "Each point is a picture. The sampling part is the error that is due to few rays: against what the method converges \
                to, after the same filter; of the hybrid it holds what the depth buffer gets wrong as well. What is left of the \
                whole error with many rays is what the filter blurs.";
    let blocks = vec![
        Block::Text(text.to_owned()),
        Block::Plot(plots::error_against_rays(outcome)),
        Block::Plot(plots::sampling_against_rays(outcome)),
    ];
    section("Error against rays", blocks)
}

fn times(outcome: &Outcome) -> Section {
    let text = "Time of the method and its filter, the middle of the runs, without the primary rays and the direct light that all \
                share, and without the colour bleeding that methods in screen space do not have. Times of methods in screen space are those of this program on the processor: they tell nothing of what \
                they take on a graphics card, where they are made for.";
    let blocks = vec![
        Block::Text(text.to_owned()),
        Block::Plot(plots::error_against_time(outcome)),
        Block::Table(tables::series(outcome)),
    ];
    section("Error against time", blocks)
}

fn moving(moving: &crate::experiment::Moving) -> Section {
    let text = format!(
        "{} frames at {} frames a second, each against its own truth ({}). Flicker is how much the error changes from frame to \
         frame: every frame has the same samples, so that their noise stands still, but for accumulated light, whose samples \
         go on. Lag is how many frames later accumulated light follows the truth than the same rays by themselves.",
        moving.frames,
        moving.fps,
        truth_in_words(&moving.truth)
    );
    let blocks = vec![
        Block::Text(text),
        Block::Table(tables::moving(moving)),
        Block::Plot(plots::error_over_frames(moving)),
    ];
    section("In motion", blocks)
}

fn methods(outcome: &Outcome) -> Section {
    let text = |method: Method| {
        let About { title, text, source } = About::of(method);
        Block::Text(format!("{title} ({source}). {text}"))
    };
    section("Methods", outcome.rows.iter().map(|row| text(row.method)).collect())
}

fn how(outcome: &Outcome, command: String) -> Section {
    let text = format!(
        "The truth is the mean of independent batches of 512 rays a pixel, each with its own scramble in every pixel, without \
         filter: {}. All pixels count. Every method sees the same depth and normals. Times are taken in turns over all methods.",
        truth_in_words(&outcome.truth)
    );
    section("How it was measured", vec![Block::Text(text), Block::Command(command)])
}

#[cfg(test)]
mod tests;
