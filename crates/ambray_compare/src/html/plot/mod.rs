//! Plots as SVG in the page: drawn without script, coloured by the style sheet, so that they follow light and dark.

mod axis;
mod marker;

use maud::{Markup, html};

use super::number::short;
use crate::document::{Plot, Series};
use axis::{Scale, Tick, shows};

/// Size of a plot, in its own units. Small, so that its words can be read on a telephone.
const WIDTH: f64 = 640.0;
const HEIGHT: f64 = 400.0;
/// Edges of the field in which the curves are.
const LEFT: f64 = 84.0;
const RIGHT: f64 = 628.0;
const TOP: f64 = 12.0;
const BOTTOM: f64 = 340.0;

/// `plot` under the id `id`.
pub(super) fn plot(plot: &Plot, id: &str) -> Markup {
    html! {
        figure.block.plot id=(id) {
            figcaption { (plot.caption) }
            @match Field::new(plot) {
                Some(field) => {
                    (drawing(plot, &field))
                    (legend(plot))
                    (left_out(plot))
                    (values(plot))
                }
                None => p.nothing { "Nothing was measured that could be shown here." }
            }
        }
    }
}

/// The field of a plot: from values to places.
struct Field {
    x: Scale,
    y: Scale,
}

impl Field {
    fn new(plot: &Plot) -> Option<Self> {
        let (x, y): (Vec<f64>, Vec<f64>) =
            plot.series.iter().flat_map(|series| shown(plot, series)).map(|p| p.1).unzip();
        Some(Self { x: Scale::new(&plot.x, x.into_iter())?, y: Scale::new(&plot.y, y.into_iter())? })
    }

    fn x(&self, value: f64) -> f64 {
        LEFT + self.x.at(value) * (RIGHT - LEFT)
    }

    fn y(&self, value: f64) -> f64 {
        BOTTOM - self.y.at(value) * (BOTTOM - TOP)
    }
}

/// The points of `series` that the axes can show, with their numbers.
fn shown<'a>(plot: &'a Plot, series: &'a Series) -> impl Iterator<Item = (usize, (f64, f64))> + 'a {
    let points = series.points.iter().copied().enumerate();
    points.filter(|(_, (x, y))| shows(&plot.x, *x) && shows(&plot.y, *y))
}

fn drawing(plot: &Plot, field: &Field) -> Markup {
    let middle = (TOP + BOTTOM) / 2.0;
    html! {
        svg.chart role="img" aria-label=(plot.caption) viewBox={ "0 0 " (WIDTH) " " (HEIGHT) } {
            g.grid {
                @for tick in field.x.ticks() { (upright(field.x(tick.value), &tick)) }
                @for tick in field.y.ticks() { (level(field.y(tick.value), &tick)) }
            }
            rect.frame x=(LEFT) y=(TOP) width=(RIGHT - LEFT) height=(BOTTOM - TOP) {}
            text.title x=((LEFT + RIGHT) / 2.0) y=(HEIGHT - 10.0) text-anchor="middle" { (plot.x.title) }
            text.title x="0" y="0" text-anchor="middle" transform={ "translate(16 " (middle) ") rotate(-90)" } {
                (plot.y.title)
            }
            @for (i, series) in plot.series.iter().enumerate() { (curve(plot, field, series, i)) }
        }
    }
}

fn upright(x: f64, tick: &Tick) -> Markup {
    html! {
        line.between[tick.label.is_none()] x1=(place(x)) x2=(place(x)) y1=(TOP) y2=(BOTTOM) {}
        @if let Some(label) = &tick.label { text.below x=(place(x)) y=(BOTTOM + 8.0) text-anchor="middle" { (label) } }
    }
}

fn level(y: f64, tick: &Tick) -> Markup {
    html! {
        line.between[tick.label.is_none()] x1=(LEFT) x2=(RIGHT) y1=(place(y)) y2=(place(y)) {}
        @if let Some(label) = &tick.label { text x=(LEFT - 7.0) y=(place(y + 4.5)) text-anchor="end" { (label) } }
    }
}

/// The line and the points of `series`. A point that the axes cannot show leaves no gap: its neighbours are joined.
fn curve(plot: &Plot, field: &Field, series: &Series, index: usize) -> Markup {
    let points: Vec<(usize, (f64, f64))> = shown(plot, series).collect();
    let path: Vec<String> =
        points.iter().map(|(_, (x, y))| format!("{},{}", place(field.x(*x)), place(field.y(*y)))).collect();
    html! {
        g class={ "series " (look(index)) } data-series=(index) {
            @if path.len() > 1 { polyline points=(path.join(" ")) {} }
            @for (i, (x, y)) in points {
                g.point transform={ "translate(" (place(field.x(x))) " " (place(field.y(y))) ")" } {
                    title { (said(series, i)) "\n" (plot.x.title) ": " (short(x)) "\n" (plot.y.title) ": " (short(y)) }
                    // Easier to point at than the marker.
                    circle.target r="11" {}
                    (marker::marker(index))
                }
            }
        }
    }
}

/// The name of a series, and what its point `i` is.
fn said(series: &Series, i: usize) -> String {
    match series.labels.get(i) {
        Some(label) if label.starts_with(&series.name) => label.clone(),
        Some(label) if !label.is_empty() => format!("{} – {label}", series.name),
        _ => series.name.clone(),
    }
}

/// Colours repeat after seven, shapes after eight and dashes begin with the second seven: 56 series look different.
fn look(index: usize) -> String {
    let dashed = if (index / marker::COLOURS) % 2 == 1 { " dashed" } else { "" };
    format!("colour-{}{dashed}", index % marker::COLOURS)
}

/// The series that can be seen.
fn legend(plot: &Plot) -> Markup {
    let seen = plot.series.iter().enumerate().filter(|(_, series)| shown(plot, series).next().is_some());
    html! {
        ul.legend {
            @for (i, series) in seen {
                li {
                    button type="button" aria-pressed="true" data-series=(i) {
                        svg class={ "swatch " (look(i)) } viewBox="-16 -8 32 16" aria-hidden="true" {
                            @if series.points.len() > 1 { polyline points="-16,0 16,0" {} }
                            (marker::marker(i))
                        }
                        (series.name)
                    }
                }
            }
        }
    }
}

/// Points that the axes cannot show, for a plot must not hide what was measured.
fn left_out(plot: &Plot) -> Markup {
    let names: Vec<String> = plot
        .series
        .iter()
        .flat_map(|series| (0..series.points.len()).map(move |i| (series, i)))
        .filter(|(series, i)| !(shows(&plot.x, series.points[*i].0) && shows(&plot.y, series.points[*i].1)))
        .map(|(series, i)| {
            let (x, y) = series.points[i];
            format!("{} ({}, {})", said(series, i), short(x), short(y))
        })
        .collect();
    html! {
        @if !names.is_empty() { p.left-out { "Not on these axes (x, y): " (names.join("; ")) "." } }
    }
}

/// The numbers behind the plot.
fn values(plot: &Plot) -> Markup {
    html! {
        details {
            summary { "Values" }
            div.wide tabindex="0" role="region" aria-label={ "Values of " (plot.caption) } {
                table {
                    thead {
                        tr {
                            th scope="col" { "Series" }
                            th.number scope="col" { (plot.x.title) }
                            th.number scope="col" { (plot.y.title) }
                        }
                    }
                    tbody {
                        @for series in &plot.series {
                            @for (i, (x, y)) in series.points.iter().enumerate() {
                                tr {
                                    th scope="row" { (said(series, i)) }
                                    td.number { (short(*x)) }
                                    td.number { (short(*y)) }
                                }
                            }
                        }
                    }
                }
            }
        }
    }
}

/// A coordinate, to a hundredth.
fn place(value: f64) -> f64 {
    (value * 100.0).round() / 100.0
}

#[cfg(test)]
mod tests;
