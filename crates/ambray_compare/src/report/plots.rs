//! Plots of what was measured.

use crate::{
    document::{Axis, Plot, Series},
    experiment::{Moving, Outcome, Row},
};

fn logarithmic(title: &str) -> Axis {
    Axis { title: title.to_owned(), logarithmic: true }
}

/// A series a subject, at the points that `point` finds. Subjects that trace rays come first, so that each has the same colour
/// in plots that leave the others out.
fn series(outcome: &Outcome, point: impl Fn(&Row) -> (f64, f64)) -> Vec<Series> {
    let of = |line: &Vec<Row>| Series {
        name: line.first().map(|row| row.name.clone()).unwrap_or_default(),
        points: line.iter().map(&point).collect(),
        labels: line.iter().map(|row| row.effort.to_string()).collect(),
    };
    let is_traced = |line: &&Vec<Row>| line.iter().any(|row| row.rays_per_pixel > 0.0);
    let (traced, others): (Vec<_>, Vec<_>) = outcome.series.iter().partition(is_traced);
    traced.into_iter().chain(others).map(of).collect()
}

/// The same without methods that trace no rays.
fn traced(outcome: &Outcome, point: impl Fn(&Row) -> (f64, f64)) -> Vec<Series> {
    let all = series(outcome, point);
    all.into_iter().filter(|series| series.points.iter().any(|&(x, _)| x > 0.0)).collect()
}

pub(super) fn error_against_rays(outcome: &Outcome) -> Plot {
    Plot {
        caption: "Error after the filter against rays.".to_owned(),
        x: logarithmic("ambient rays a pixel"),
        y: logarithmic("RMSE"),
        series: traced(outcome, |row| (row.rays_per_pixel, row.measures.rmse)),
    }
}

pub(super) fn sampling_against_rays(outcome: &Outcome) -> Plot {
    Plot {
        caption: "Sampling part of the error against rays.".to_owned(),
        x: logarithmic("ambient rays a pixel"),
        y: logarithmic("sampling part"),
        series: traced(outcome, |row| (row.rays_per_pixel, row.measures.sampling_part.unwrap_or_default())),
    }
}

pub(super) fn error_against_time(outcome: &Outcome) -> Plot {
    Plot {
        caption: "Error after the filter against time.".to_owned(),
        x: logarithmic("milliseconds"),
        y: logarithmic("RMSE"),
        series: series(outcome, |row| (row.milliseconds.median, row.measures.rmse)),
    }
}

pub(super) fn error_over_frames(moving: &Moving) -> Plot {
    let of = |(name, values): (&String, &Vec<f64>)| Series {
        name: name.clone(),
        points: values.iter().enumerate().map(|(k, &rmse)| (k as f64, rmse)).collect(),
        labels: (0..values.len()).map(|k| format!("frame {k}")).collect(),
    };
    Plot {
        caption: "Error of each frame.".to_owned(),
        x: Axis { title: "frame".to_owned(), logarithmic: false },
        y: logarithmic("RMSE"),
        series: moving.rows.iter().map(|row| of((&row.name, &row.rmse))).collect(),
    }
}
