//! Tables: sorted by a click on a heading, the best number of a column marked.

use maud::{Markup, html};

use super::number::fixed;
use crate::document::{Best, Cell, Column, Table};

/// `table` under the id `id`.
pub(super) fn table(table: &Table, id: &str) -> Markup {
    let best = best_cells(table);
    html! {
        figure.block.data id=(id) {
            figcaption { (table.caption) }
            div.wide tabindex="0" role="region" aria-label=(table.caption) {
                table.sortable {
                    thead {
                        tr {
                            @for (i, column) in table.columns.iter().enumerate() { (heading(table, column, i)) }
                        }
                    }
                    tbody {
                        @for (row, best) in table.rows.iter().zip(&best) {
                            tr {
                                @for (i, (value, best)) in row.iter().zip(best).enumerate() {
                                    (cell(value, *best, i == 0))
                                }
                            }
                        }
                    }
                }
            }
            (meanings(&table.columns))
        }
    }
}

fn heading(table: &Table, column: &Column, index: usize) -> Markup {
    let is_number = table.rows.iter().any(|row| matches!(row.get(index), Some(Cell::Number(..))));
    // The best ones come first at the first click.
    let first = if column.best == Best::Largest { "descending" } else { "ascending" };
    let meaning = (!column.meaning.is_empty()).then_some(&column.meaning);
    html! {
        th scope="col" class=[is_number.then_some("number")] aria-sort="none" data-first=(first)
            data-by=[(column.best == Best::NearestZero).then_some("size")] {
            button type="button" title=[meaning] { (column.title) }
        }
    }
}

fn cell(value: &Cell, is_best: bool, is_first: bool) -> Markup {
    match value {
        Cell::Text(text) if is_first => html! { th scope="row" { (text) } },
        Cell::Text(text) => html! { td { (text) } },
        Cell::Number(value, decimals) => html! {
            td.number.best[is_best] data-value=(value) {
                @if is_best { strong title="the best of this column" { (fixed(*value, *decimals)) } }
                @else { (fixed(*value, *decimals)) }
            }
        },
        Cell::Empty => html! { td.number.empty { "–" } },
    }
}

/// What the headings mean, for who cannot point at them.
fn meanings(columns: &[Column]) -> Markup {
    let explained: Vec<&Column> = columns.iter().filter(|column| !column.meaning.is_empty()).collect();
    html! {
        @if !explained.is_empty() {
            details {
                summary { "What the columns mean" }
                dl {
                    @for column in explained { dt { (column.title) } dd { (column.meaning) } }
                }
            }
        }
    }
}

/// Which cells are the best of their columns, row by row. Numbers that read the same are equally good; where all do, or
/// where there is one only, none is marked.
fn best_cells(table: &Table) -> Vec<Vec<bool>> {
    let mut marks: Vec<Vec<bool>> = table.rows.iter().map(|row| vec![false; row.len()]).collect();
    for (i, column) in table.columns.iter().enumerate() {
        let numbers: Vec<(usize, f64, String)> = table
            .rows
            .iter()
            .enumerate()
            .filter_map(|(row, cells)| match cells.get(i) {
                Some(Cell::Number(value, decimals)) if !value.is_nan() => {
                    Some((row, *value, fixed(*value, *decimals)))
                }
                _ => None,
            })
            .collect();
        let badness = |value: f64| match column.best {
            Best::None => None,
            Best::Smallest => Some(value),
            Best::Largest => Some(-value),
            Best::NearestZero => Some(value.abs()),
        };
        let best = numbers.iter().filter_map(|number| Some((badness(number.1)?, &number.2)));
        let Some((_, best)) = best.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        // A sign does not make an error near zero better.
        let size = |text: &str| match column.best {
            Best::NearestZero => text.trim_start_matches('-').to_owned(),
            _ => text.to_owned(),
        };
        let equal: Vec<usize> =
            numbers.iter().filter(|number| size(&number.2) == size(best)).map(|number| number.0).collect();
        if equal.len() < numbers.len() {
            equal.into_iter().for_each(|row| marks[row][i] = true);
        }
    }
    marks
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rows of the marked cells of a column.
    #[track_caller]
    fn check(best: Best, values: &[Cell], expected: &[usize]) {
        let column = Column { title: "RMSE".into(), meaning: String::new(), best };
        let rows = values.iter().map(|value| vec![value.clone()]).collect();
        let marks = best_cells(&Table { caption: String::new(), columns: vec![column], rows });
        let marked: Vec<usize> = (0..values.len()).filter(|&row| marks[row][0]).collect();
        assert_eq!(marked, expected, "{best:?} of {values:?}");
    }

    fn numbers(values: &[f64]) -> Vec<Cell> {
        values.iter().map(|&value| Cell::Number(value, 2)).collect()
    }

    #[test]
    fn the_best_number_is_marked() {
        check(Best::Smallest, &numbers(&[0.3, -0.1, 0.2]), &[1]);
        check(Best::Largest, &numbers(&[0.3, -0.1, 0.2]), &[0]);
        check(Best::NearestZero, &numbers(&[0.3, -0.1, 0.2]), &[1]);
        check(Best::None, &numbers(&[0.3, -0.1, 0.2]), &[]);
    }

    #[test]
    fn numbers_that_read_the_same_are_equally_good() {
        check(Best::Smallest, &numbers(&[0.101, 0.5, 0.104]), &[0, 2]);
        check(Best::NearestZero, &numbers(&[0.101, 0.5, -0.104]), &[0, 2]);
        check(Best::Smallest, &numbers(&[0.101, 0.104]), &[]);
        check(Best::Smallest, &numbers(&[0.101]), &[]);
    }

    #[test]
    fn what_was_not_measured_is_not_the_best() {
        let mut values = numbers(&[f64::NAN, 20.0, f64::INFINITY]);
        values.push(Cell::Empty);
        check(Best::Largest, &values, &[2]);
        check(Best::Smallest, &values, &[1]);
    }

    #[test]
    fn numbers_carry_their_value_and_the_best_is_bold() {
        let columns = [("Method", Best::None), ("PSNR", Best::Largest)];
        let columns =
            columns.map(|(title, best)| Column { title: title.into(), meaning: "<what>".into(), best });
        let rows = vec![
            vec![Cell::Text("a & b".into()), Cell::Number(32.14, 1)],
            vec![Cell::Text("c".into()), Cell::Number(28.0, 1)],
        ];
        let page =
            table(&Table { caption: "Errors".into(), columns: columns.into(), rows }, "t").into_string();
        assert!(page.contains(r#"data-value="32.14""#), "{page}");
        assert!(page.contains(r#"<strong title="the best of this column">32.1</strong>"#), "{page}");
        assert_eq!(page.matches("<strong").count(), 1);
        assert!(
            page.contains("a &amp; b") && page.contains("&lt;what&gt;") && !page.contains("<what>"),
            "{page}"
        );
        assert!(page.contains(r#"data-first="descending""#), "{page}");
    }
}
