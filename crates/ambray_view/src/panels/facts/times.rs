//! What the last pictures took: a stacked plot of their stages, and the numbers of the newest.

use std::time::Duration;

use ambray::{Machine, StageTimes};
use egui::{Grid, RichText, Ui};
use egui_plot::{Bar, BarChart, Plot};

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
    for (i, name) in NAMES.iter().enumerate() {
        let first = (TIMINGS - desk.shown.timings.len().min(TIMINGS)) as f64;
        let bars = desk.shown.timings.iter().enumerate().map(|(at, timing)| {
            Bar::new(first + at as f64, stages(&timing.stats.times)[i]).width(1.0).stroke(egui::Stroke::NONE)
        });
        let chart = BarChart::new(*name, bars.collect()).color(look::STAGES[i]).allow_hover(false);
        let below: Vec<&BarChart> = charts.iter().collect();
        let chart = chart.stack_on(&below);
        charts.push(chart);
    }
    Plot::new("frame times")
        .height(96.0)
        .include_x(0.0)
        .include_x(TIMINGS as f64)
        .include_y(0.0)
        .show_x(false)
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

fn numbers(ui: &mut Ui, timing: &Timing) {
    let stats = &timing.stats;
    Grid::new("stages").num_columns(4).spacing([10.0, 2.0]).show(ui, |ui| {
        let (times, rays) = (stages(&stats.times), stats.rays);
        let rays = [
            ("primary", rays.primary),
            ("ambient", rays.ambient),
            ("chords", rays.chord),
            ("shadow", rays.shadow),
            ("all rays", rays.total()),
        ];
        let seconds = stats.times.total.as_secs_f64().max(1e-9);
        for i in 0..NAMES.len() {
            ui.label(RichText::new(NAMES[i]).color(look::STAGES[i]));
            ui.label(RichText::new(format!("{:>8.2} ms", times[i])).monospace());
            if let Some((name, count)) = rays.get(i) {
                ui.label(RichText::new(*name).weak());
                ui.label(RichText::new(format!("{:>8}", look::count(*count))).monospace());
            } else {
                ui.label(RichText::new("speed").weak());
                let speed = stats.rays.total() as f64 / seconds / 1e6;
                ui.label(RichText::new(format!("{speed:>6.1} Mrays/s")).monospace());
            }
            ui.end_row();
        }
        ui.label(RichText::new("all").strong());
        ui.label(RichText::new(format!("{:>8.2} ms", ms(stats.times.total))).monospace().strong());
        ui.label(RichText::new("threads").weak());
        ui.label(RichText::new(format!("{:>8}", stats.threads)).monospace());
        ui.end_row();
    });
}

/// How far the pictures of the sides are refined.
fn level(ui: &mut Ui, desk: &Desk<'_>) {
    for &side in desk.model.sides() {
        let Some(rendered) = &desk.shown.sides[side as usize] else { continue };
        let level = rendered.level;
        let name = if desk.model.sides().len() == 2 { format!("{side:?}: ") } else { String::new() };
        let size = rendered.settings.size;
        let state = match desk.shown.progress[side as usize] {
            Some(share) => format!("{name}refining, {:.0} %", 100.0 * share),
            None if level.is_final => format!("{name}final, {size}, {} rays a pixel", level.spp),
            None => format!("{name}scale {:.3}, {} rays a pixel", level.scale, level.spp),
        };
        let known = if level.is_final { 1.0 } else { level.scale * level.scale };
        look::share_bar(ui, desk.shown.progress[side as usize].unwrap_or(known), &state);
    }
}

fn machine(ui: &mut Ui, desk: &Desk<'_>) {
    let Some(opened) = &desk.shown.opened else { return };
    Grid::new("machine").num_columns(2).spacing([10.0, 2.0]).show(ui, |ui| {
        match &opened.machine {
            Machine::Cpu { isa, .. } => look::fact(ui, "machine", format!("processor, {isa}")),
            Machine::Vulkan { device, trace } => {
                look::fact(ui, "machine", device);
                look::fact(ui, "rays", format!("{trace:?}").to_lowercase());
            }
        }
        look::fact(ui, "trees", look::bytes(opened.build.acceleration_bytes));
        look::fact(ui, "planes", look::bytes(planes(desk)));
    });
    if let Machine::Cpu { reason: Some(reason), .. } = &opened.machine {
        ui.add(egui::Label::new(RichText::new(format!("No device: {reason}")).weak().small()).wrap());
    }
}

/// Bytes of the pictures of the sides that are shown.
fn planes(desk: &Desk<'_>) -> u64 {
    desk.shown.sides.iter().flatten().map(|rendered| rendered.frame_bytes).sum()
}
