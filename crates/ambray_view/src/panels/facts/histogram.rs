//! A histogram of up to three channels, with two ends to drag.

use egui::{Color32, CornerRadius, Mesh, Rect, Sense, Stroke, Ui, emath::GuiRounding as _, pos2, vec2};

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
        fill(ui, rect, bins, color.gamma_multiply(0.55), |n| height(n) / top);
    }
    let Statistics { low, high, .. } = *statistics;
    if let Some(at) = response.hover_pos() {
        let value = low + (at.x - rect.left()) / rect.width() * (high - low);
        response.on_hover_text_at_pointer(format!("{value:.5}"));
    }
    handles.map_or_else(Shown::default, |handles| drag(ui, rect, (low, high), handles))
}

/// Fills the columns of pixels in `rect` to the share that `height` gives to the largest of the bins in each.
fn fill(ui: &Ui, rect: Rect, bins: &[u32], color: Color32, height: impl Fn(u32) -> f32) {
    let pixel = 1.0 / ui.ctx().pixels_per_point();
    let columns = (rect.width() / pixel).floor().max(1.0) as usize;
    let left = rect.left().round_to_pixels(ui.ctx().pixels_per_point());
    // A mesh is not smoothed at its edges: columns of whole pixels have no seams.
    let mut mesh = Mesh::default();
    for column in 0..columns {
        let Some(largest) = bins_of(column, columns, bins.len()).filter_map(|bin| bins.get(bin)).max() else {
            continue;
        };
        let x = left + column as f32 * pixel;
        let bar = Rect::from_min_max(
            pos2(x, rect.bottom() - rect.height() * height(*largest)),
            pos2(x + pixel, rect.bottom()),
        );
        mesh.add_colored_rect(bar, color);
    }
    ui.painter().add(mesh);
}

/// The bins that a column shows: at least one, and each bin is in some column.
fn bins_of(column: usize, columns: usize, bins: usize) -> std::ops::Range<usize> {
    let first = column * bins / columns;
    first..((column + 1) * bins / columns).max(first + 1)
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
