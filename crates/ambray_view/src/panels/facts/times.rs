//! What the last pictures took: a stacked plot of their stages, and the numbers of the newest.

use std::time::Duration;

use ambray::{Machine, StageTimes};
use egui::{RichText, Ui};
use egui_plot::{Bar, BarChart, GridMark, Plot};

use crate::{
    app::{TIMINGS, Timing},
    panels::{Desk, look},
};

/// Names of the stages, in the order of [`look::STAGES`].
const NAMES: [&str; 6] = ["primary", "direct", "ambient", "filter", "motion", "transfer"];

/// Times of the stages, milliseconds.
fn stages(times: &StageTimes) -> [f64; 6] {
    let motion = times.deformation + times.bottom_level + times.top_level;
    [times.primary, times.direct, times.ambient, times.filter, motion, times.transfer].map(ms)
}

fn ms(duration: Duration) -> f64 {
    1e3 * duration.as_secs_f64()
}

pub(super) fn show(ui: &mut Ui, desk: &mut Desk<'_>) {
    plot(ui, desk);
    let Some(newest) = desk.shown.timings.back().copied() else {
        ui.weak("No picture yet");
        return;
    };
    numbers(ui, &newest);
    level(ui, desk);
    ui.separator();
    machine(ui, desk);
}

fn plot(ui: &mut Ui, desk: &Desk<'_>) {
    let mut charts: Vec<BarChart> = Vec::new();
    let timings = &desk.shown.timings;
    // As many as there are, so that the first ones can be seen, too.
    let places = timings.len().clamp(24, TIMINGS);
    let highest = timings.iter().map(|timing| stages(&timing.stats.times).iter().sum()).fold(1e-3, f64::max);
    for (i, name) in NAMES.iter().enumerate() {
        let first = (places - timings.len().min(places)) as f64 + 0.5;
        let bars = timings.iter().enumerate().map(|(at, timing)| {
            Bar::new(first + at as f64, stages(&timing.stats.times)[i])
                .width(1.0)
                .fill(look::STAGES[i])
                .stroke(egui::Stroke::NONE)
        });
        let chart = BarChart::new(*name, bars.collect()).color(look::STAGES[i]).allow_hover(false);
        let below: Vec<&BarChart> = charts.iter().collect();
        let chart = chart.stack_on(&below);
        charts.push(chart);
    }
    Plot::new("frame times")
        .height(96.0)
        .include_x(0.0)
        .include_x(places as f64)
        .include_y(0.0)
        .include_y(highest)
        .show_x(false)
        .show_grid([false, true])
        .y_grid_spacer(move |_| marks(highest))
        .show_axes([false, true])
        .y_axis_formatter(|mark, _| format!("{} ms", mark.value))
        .y_axis_min_width(40.0)
        .allow_drag(false)
        .allow_zoom(false)
        .allow_scroll(false)
        .allow_boxed_zoom(false)
        .allow_axis_zoom_drag(false)
        .show(ui, |plot| charts.into_iter().for_each(|chart| plot.bar_chart(chart)));
}

/// Marks at zero, and at one or two round values below the top.
fn marks(highest: f64) -> Vec<GridMark> {
    let decade = 10f64.powf(highest.log10().floor());
    let step = [5.0, 2.0, 1.0].into_iter().map(|n| n * decade).find(|step| *step <= highest);
    let step = step.unwrap_or(decade);
    let values = (0..3).map(|i| f64::from(i) * step).filter(|value| *value <= highest);
    values.map(|value| GridMark { value, step_size: step }).collect()
}

fn numbers(ui: &mut Ui, timing: &Timing) {
    let stats = &timing.stats;
    let rays = stats.rays;
    let seconds = stats.times.total.as_secs_f64().max(1e-9);
    let of_type = |name, count| Some((RichText::new(name).weak(), look::count(count)));
    let beside = [
        of_type("primary", rays.primary),
        of_type("ambient", rays.ambient),
        of_type("chords", rays.chord),
        of_type("shadow", rays.shadow),
        of_type("all rays", rays.total()),
        Some((RichText::new("Mrays/s").weak(), format!("{:.1}", rays.total() as f64 / seconds / 1e6))),
    ];
    for ((name, time), (beside, color)) in
        NAMES.iter().zip(stages(&stats.times)).zip(beside.into_iter().zip(look::STAGES))
    {
        look::columns(ui, [Some((RichText::new(*name).color(color), milliseconds(time))), beside]);
    }
    let all = (RichText::new("all").strong(), milliseconds(ms(stats.times.total)));
    // A device has no threads that could be counted.
    let threads = (stats.threads > 0).then(|| (RichText::new("threads").weak(), stats.threads.to_string()));
    look::columns(ui, [Some(all), threads]);
}

/// A time with as many digits as are worth reading.
fn milliseconds(time: f64) -> String {
    let decimals = if time < 100.0 { 2 } else { 0 };
    format!("{time:.decimals$} ms")
}

/// How far the pictures of the sides are refined.
fn level(ui: &mut Ui, desk: &Desk<'_>) {
    for &side in desk.model.sides() {
        let Some(rendered) = &desk.shown.sides[side as usize] else { continue };
        let level = rendered.level;
        let name = if desk.model.sides().len() == 2 { format!("{side:?}: ") } else { String::new() };
        let size = rendered.settings.size;
        let rays = if level.spp > 0 { format!(", {} rays a pixel", level.spp) } else { String::new() };
        let state = match desk.shown.progress[side as usize] {
            Some(share) => format!("{name}refining, {:.0} %", 100.0 * share),
            None if level.is_final => format!("{name}final, {size}{rays}"),
            None => format!("{name}scale {:.3}{rays}", level.scale),
        };
        let known = if level.is_final { 1.0 } else { level.scale * level.scale };
        look::share_bar(ui, desk.shown.progress[side as usize].unwrap_or(known), &state);
    }
}

/// Who rendered the pictures that are shown, and what these take.
fn machine(ui: &mut Ui, desk: &Desk<'_>) {
    let Some(opened) = &desk.shown.opened else { return };
    let sides = desk.model.sides();
    let rendered: Vec<_> =
        sides.iter().filter_map(|&side| desk.shown.sides[side as usize].as_ref()).collect();
    match &rendered[..] {
        [a, b] if a.machine != b.machine => {
            for rendered in [a, b] {
                named(ui, &format!("machine {:?}", rendered.side), &rendered.machine);
            }
        }
        [rendered, ..] => named(ui, "machine", &rendered.machine),
        [] => named(ui, "machine", &opened.machine),
    }
    look::fact(ui, "trees", look::bytes(opened.build.acceleration_bytes));
    look::fact(ui, "planes", look::bytes(planes(desk)));
}

fn named(ui: &mut Ui, name: &str, machine: &Machine) {
    match machine {
        Machine::Cpu { isa, reason } => {
            look::fact(ui, name, format!("processor, {isa}"));
            if let Some(reason) = reason {
                let text = RichText::new(format!("On the processor: {reason}")).weak().small();
                ui.add(egui::Label::new(text).wrap());
            }
        }
        Machine::Vulkan { device, trace } => {
            look::fact(ui, name, device);
            look::fact(ui, "rays", format!("{trace:?}").to_lowercase());
        }
    }
}

/// Bytes of the pictures of the sides that are shown; on a device one takes the place of the other.
fn planes(desk: &Desk<'_>) -> u64 {
    let of = |on_device: bool| {
        let rendered = desk.shown.sides.iter().flatten();
        let rendered = rendered.filter(move |r| matches!(r.machine, Machine::Vulkan { .. }) == on_device);
        rendered.map(|rendered| rendered.frame_bytes)
    };
    of(true).max().unwrap_or(0) + of(false).sum::<u64>()
}
