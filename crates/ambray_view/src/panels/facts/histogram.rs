//! A histogram of up to three channels, with two ends to drag.

use egui::{Color32, CornerRadius, Rect, Sense, Stroke, Ui, pos2, vec2};

use crate::{engine::Statistics, panels::look};

/// The ends of a range of values.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Handles {
    pub(super) low: f32,
    pub(super) high: f32,
}

/// What was done with a histogram.
#[derive(Debug, Default)]
pub(super) struct Shown {
    pub(super) moved: Option<Handles>,
    pub(super) is_dragged: bool,
}

const HEIGHT: f32 = 84.0;

pub(super) fn show(ui: &mut Ui, statistics: &Statistics, is_log: bool, handles: Option<Handles>) -> Shown {
    let (rect, response) = ui.allocate_exact_size(vec2(ui.available_width(), HEIGHT), Sense::hover());
    ui.painter().rect_filled(rect, CornerRadius::same(2), ui.visuals().extreme_bg_color);
    let colors: &[Color32] = match statistics.histogram.len() {
        1 => &[Color32::from_gray(190)],
        _ => &[
            Color32::from_rgb(206, 92, 84),
            Color32::from_rgb(104, 178, 96),
            Color32::from_rgb(96, 132, 214),
        ],
    };
    let height = |n: u32| if is_log { f32::ln_1p(n as f32) } else { n as f32 };
    let top = statistics.histogram.iter().flatten().map(|&n| height(n)).fold(1.0, f32::max);
    for (bins, color) in statistics.histogram.iter().zip(colors) {
        let width = rect.width() / bins.len().max(1) as f32;
        for (i, &n) in bins.iter().enumerate().filter(|(_, n)| **n > 0) {
            let left = rect.left() + i as f32 * width;
            let bar = Rect::from_min_max(
                pos2(left, rect.bottom() - rect.height() * height(n) / top),
                pos2(left + width.max(1.0), rect.bottom()),
            );
            ui.painter().rect_filled(bar, 0.0, color.gamma_multiply(0.55));
        }
    }
    let Statistics { low, high, .. } = *statistics;
    if let Some(at) = response.hover_pos() {
        let value = low + (at.x - rect.left()) / rect.width() * (high - low);
        response.on_hover_text_at_pointer(format!("{value:.5}"));
    }
    handles.map_or_else(Shown::default, |handles| drag(ui, rect, (low, high), handles))
}

fn drag(ui: &Ui, rect: Rect, (low, high): (f32, f32), handles: Handles) -> Shown {
    let mut shown = Shown::default();
    let span = if high > low { high - low } else { 1.0 };
    for (is_low, value) in [(true, handles.low), (false, handles.high)] {
        let x = rect.left() + rect.width() * ((value - low) / span).clamp(0.0, 1.0);
        let grip = Rect::from_center_size(pos2(x, rect.center().y), vec2(9.0, rect.height()));
        let response = ui.interact(grip, ui.id().with(("histogram end", is_low)), Sense::drag());
        response.widget_info(|| {
            let name = if is_low { "low end of the range" } else { "high end of the range" };
            egui::WidgetInfo::slider(true, f64::from(value), name)
        });
        let color = if response.hovered() || response.dragged() { Color32::WHITE } else { look::ACCENT };
        ui.painter().vline(x, rect.y_range(), Stroke::new(1.5, color));
        shown.is_dragged |= response.dragged();
        if let Some(at) = response.interact_pointer_pos().filter(|_| response.dragged()) {
            let value = low + ((at.x - rect.left()) / rect.width()).clamp(0.0, 1.0) * span;
            shown.moved = Some(if is_low {
                Handles { low: value, ..handles }
            } else {
                Handles { high: value, ..handles }
            });
        }
        response.on_hover_cursor(egui::CursorIcon::ResizeHorizontal);
    }
    shown
}
