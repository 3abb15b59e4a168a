//! What was compared, as a table for the terminal.

use std::fmt::Write as _;

use ambray_compare::{experiment::Outcome, paper::Paper, report::truth_in_words};

use super::Measured;

/// What was measured, for people.
pub(super) fn of(measured: &Measured) -> String {
    match measured {
        Measured::Comparison(outcome) => comparison_text(outcome),
        Measured::Paper(paper) => paper_text(paper),
    }
}

fn comparison_text(outcome: &Outcome) -> String {
    let mut text = format!("truth    {}\n\n", truth_in_words(&outcome.truth));
    let _ = writeln!(
        text,
        "{:20} {:>8} {:>10} {:>9} {:>8} {:>8} {:>9} {:>7} {:>9}",
        "method", "effort", "rays/pixel", "ms", "RMSE", "PSNR", "bias", "FLIP", "sampling"
    );
    let or_none = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), |value| format!("{value:.4}"));
    for row in &outcome.rows {
        let measures = &row.measures;
        let _ = writeln!(
            text,
            "{:20} {:>8} {:>10.2} {:>9.1} {:>8.4} {:>8.2} {:>+9.4} {:>7} {:>9}",
            row.name,
            row.effort.to_string(),
            row.rays_per_pixel,
            row.milliseconds.median,
            measures.rmse,
            measures.psnr.unwrap_or(f64::INFINITY),
            measures.bias,
            or_none(measures.flip),
            or_none(measures.sampling_part),
        );
    }
    if let Some(moving) = &outcome.sequence {
        let _ = writeln!(text, "\n{:20} {:>9} {:>12}", "in motion", "flicker", "lag, frames");
        for row in &moving.rows {
            let lag = row.lag.map_or_else(|| "-".to_owned(), |lag| format!("{lag:.3}"));
            let _ = writeln!(text, "{:20} {:>9.5} {lag:>12}", row.name, row.flicker);
        }
    }
    text.push('\n');
    text
}

fn paper_text(paper: &Paper) -> String {
    let mut text = format!("truth    {}\n\n", truth_in_words(&paper.truth));
    text +=
        &format!("{:8} {:32} {:>8} {:>8} {:>9} {:>7}\n", "figure", "picture", "RMSE", "PSNR", "bias", "FLIP");
    for picture in &paper.pictures {
        let measures = &picture.measures;
        let _ = writeln!(
            text,
            "{:8} {:32} {:>8.4} {:>8.2} {:>+9.4} {:>7.4}",
            picture.figure,
            picture.name,
            measures.rmse,
            measures.psnr.unwrap_or(f64::INFINITY),
            measures.bias,
            measures.flip.unwrap_or_default()
        );
    }
    let _ = writeln!(text, "\n{:8} {:>11} {:>10} {:>9}", "thin", "ambient, ms", "frame, ms", "chords");
    for times in &paper.times {
        let _ = writeln!(
            text,
            "{:8} {:>11.1} {:>10.1} {:>9.2}",
            times.thin, times.ambient.median, times.total.median, times.chords_per_pixel
        );
    }
    text.push('\n');
    text
}
