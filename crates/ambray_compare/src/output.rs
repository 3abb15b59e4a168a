//! Reports for programs: tables as CSV.

use ambray_metrics::{Measure, Measures};

use crate::{
    experiment::{Outcome, Row},
    paper::Paper,
};

/// Everything that was measured of still pictures, a line a row: those of the table, then those of the plots.
#[must_use]
pub fn csv(outcome: &Outcome) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let first = [
        "place",
        "name",
        "method",
        "effort",
        "rays-per-pixel",
        "min-ms",
        "median-ms",
        "p95-ms",
        "runs",
        "by",
    ];
    let last = ["mean-openness", "raw-rmse", "fitted-rmse"];
    let measures = Measure::ALL.iter().map(|measure| measure.name());
    let mut write = |line: Vec<String>| writer.write_record(line).expect("memory takes everything");
    write(first.into_iter().chain(last).chain(measures).map(str::to_owned).collect());
    outcome.rows.iter().for_each(|row| write(line("table", row)));
    outcome.series.iter().flatten().for_each(|row| write(line("plots", row)));
    let bytes = writer.into_inner().expect("memory takes everything");
    String::from_utf8(bytes).expect("names and numbers")
}

/// Errors of the pictures of the paper's figures, a line a picture.
#[must_use]
pub fn paper_csv(paper: &Paper) -> String {
    let mut writer = csv::Writer::from_writer(Vec::new());
    let names = Measure::ALL.iter().map(|measure| measure.name());
    let mut write = |line: Vec<String>| writer.write_record(line).expect("memory takes everything");
    write(["figure", "name"].into_iter().chain(names).map(str::to_owned).collect());
    for picture in &paper.pictures {
        let mut line = vec![picture.figure.clone(), picture.name.clone()];
        line.extend(values(&picture.measures));
        write(line);
    }
    let bytes = writer.into_inner().expect("memory takes everything");
    String::from_utf8(bytes).expect("names and numbers")
}

fn values(measures: &Measures) -> impl Iterator<Item = String> + '_ {
    let number = |measure: &Measure| measures.get(*measure).map(|value| value.to_string());
    Measure::ALL.iter().map(move |measure| number(measure).unwrap_or_default())
}

fn line(place: &str, row: &Row) -> Vec<String> {
    let time = &row.milliseconds;
    let mut line = vec![
        place.to_owned(),
        row.name.clone(),
        row.method.to_string(),
        row.effort.to_string(),
        row.rays_per_pixel.to_string(),
        time.min.to_string(),
        time.median.to_string(),
        time.p95.to_string(),
        time.count.to_string(),
        row.who.to_string(),
        row.mean_openness.to_string(),
        row.raw_rmse.to_string(),
        row.fitted_rmse.to_string(),
    ];
    line.extend(values(&row.measures));
    line
}
