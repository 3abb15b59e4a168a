//! Tables of what was measured.

use ambray_metrics::{Better, Measure, Measures};

use crate::{
    document::{Best, Cell, Column, Table},
    experiment::{Moving, Outcome, Row},
};

/// Measures of the tables, in their order. The largest error is left out: it is one pixel's.
const SHOWN: [Measure; 12] = [
    Measure::Rmse,
    Measure::Psnr,
    Measure::Bias,
    Measure::P99,
    Measure::Flip,
    Measure::Ssim,
    Measure::SamplingPart,
    Measure::FilterLoss,
    Measure::EdgeRmse,
    Measure::FlatRmse,
    Measure::Grain,
    Measure::PatternLeft,
];

/// A column of `measure`.
fn column(measure: Measure) -> Column {
    let unit = if measure.unit().is_empty() { String::new() } else { format!(", {}", measure.unit()) };
    Column {
        title: format!("{}{unit}", measure.title()),
        meaning: measure.meaning().to_owned(),
        best: match measure.better() {
            Better::Smaller => Best::Smallest,
            Better::Larger => Best::Largest,
            Better::NearerZero => Best::NearestZero,
        },
    }
}

fn plain(title: &str, meaning: &str, best: Best) -> Column {
    Column { title: title.to_owned(), meaning: meaning.to_owned(), best }
}

/// A number with so many decimals; an empty cell if it was not measured.
#[must_use]
pub fn number(value: Option<f64>, decimals: usize) -> Cell {
    value.map_or(Cell::Empty, |value| Cell::Number(value, decimals))
}

fn cells(measures: &Measures) -> impl Iterator<Item = Cell> + '_ {
    SHOWN.iter().map(|&measure| number(measures.get(measure), measure.decimals()))
}

/// A table of the measures of named estimates.
#[must_use]
pub fn measures_table(caption: String, rows: &[(String, Measures)]) -> Table {
    let mut columns = vec![plain("", "", Best::None)];
    columns.extend(SHOWN.iter().map(|&measure| column(measure)));
    let row = |(name, measures): &(String, Measures)| {
        std::iter::once(Cell::Text(name.clone())).chain(cells(measures)).collect()
    };
    Table { caption, columns, rows: rows.iter().map(row).collect() }
}

/// Everything that was measured of `rows`.
pub(super) fn rows(rows: &[Row]) -> Table {
    // Times on different machines cannot be compared.
    let fastest = if is_one_machine(rows) { Best::Smallest } else { Best::None };
    let mut columns = vec![
        plain("method", "", Best::None),
        plain("effort", "Rays a pixel, or the quality of a method that takes none", Best::None),
        plain("rays/pixel", "Ambient rays that were traced, chords included", Best::None),
        plain("time, ms", "Median time of the method and its filter, without colour bleeding", fastest),
        plain(
            "p95, ms",
            "Time that 95 % of the runs did not exceed; of less than 20 runs the longest",
            Best::None,
        ),
        plain("by", "Who computed it", Best::None),
        plain("raw RMSE", "Root mean square error before the filter", Best::Smallest),
    ];
    columns.extend(SHOWN.iter().map(|&measure| column(measure)));
    columns.push(plain(
        "fitted RMSE",
        "Root mean square error after the line through the estimate that fits the truth best: what is wrong with its \
         structure, whatever its strength",
        Best::Smallest,
    ));
    let row = |row: &Row| {
        let mut line = vec![
            Cell::Text(row.name.clone()),
            Cell::Text(row.effort.to_string()),
            Cell::Number(row.rays_per_pixel, 2),
            Cell::Number(row.milliseconds.median, 1),
            Cell::Number(row.milliseconds.p95, 1),
            Cell::Text(row.who.to_string()),
            Cell::Number(row.raw_rmse, 5),
        ];
        line.extend(cells(&row.measures));
        line.push(Cell::Number(row.fitted_rmse, 5));
        line
    };
    Table {
        caption: "Errors of openness. Point at a heading to read what it means; click it to sort.".to_owned(),
        columns,
        rows: rows.iter().map(row).collect(),
    }
}

/// Whether the same machine computed all of `rows`.
fn is_one_machine(rows: &[Row]) -> bool {
    rows.iter().all(|row| row.who == rows[0].who)
}

/// The points of the plots.
pub(super) fn series(outcome: &Outcome) -> Table {
    let all: Vec<Row> = outcome.series.iter().flatten().cloned().collect();
    Table { caption: "The points of the plots.".to_owned(), ..rows(&all) }
}

/// What was measured of a sequence.
pub(super) fn moving(moving: &Moving) -> Table {
    let columns = vec![
        plain("method", "", Best::None),
        plain("RMSE", "Root mean square error over all frames", Best::Smallest),
        plain("flicker", "Root mean square change of the error from frame to frame", Best::Smallest),
        plain(
            "lag, frames",
            "How much later it is than the same rays by themselves, where the truth changes",
            Best::None,
        ),
        plain("RMSE where it changes", "Root mean square error where the truth changes", Best::Smallest),
    ];
    let rows = moving.rows.iter().map(|row| {
        let squares: f64 = row.rmse.iter().map(|rmse| rmse * rmse).sum();
        vec![
            Cell::Text(row.name.clone()),
            Cell::Number((squares / row.rmse.len().max(1) as f64).sqrt(), 5),
            Cell::Number(row.flicker, 5),
            number(row.lag, 3),
            number(row.changing_rmse, 5),
        ]
    });
    Table { caption: "Errors over the sequence.".to_owned(), columns, rows: rows.collect() }
}
