//! The inspector's window: values of a pixel, its rays, chords and taps in words and numbers.

use ambray::{
    Aov, Frame,
    inspect::{Inspection, Tap},
};
use egui::{Color32, Grid, Label, RichText, ScrollArea, Sense, StrokeKind, TextStyle, Ui, Vec2, vec2};

use super::legend::Kind;

/// Height of a list, points.
const LIST: f32 = 150.0;
/// Side of a tap in the magnified window of the filter, points.
const TAP: f32 = 22.0;

/// The values of every plane at a pixel.
pub(super) fn values(ui: &mut Ui, frame: &Frame, pixel: (u32, u32)) {
    Grid::new("values").num_columns(2).striped(true).spacing(vec2(12.0, 2.0)).show(ui, |ui| {
        for &aov in Aov::ALL {
            ui.label(aov.name()).on_hover_text(aov.description());
            ui.monospace(numbers(&frame.pixel(aov, pixel)));
            ui.end_row();
        }
    });
}

/// Numbers beside each other.
fn numbers(values: &[f32]) -> String {
    let number = |value: &f32| {
        if value.fract() == 0.0 && value.abs() < 1e6 {
            format!("{value:>9}")
        } else {
            format!("{value:>9.4}")
        }
    };
    values.iter().map(number).collect::<Vec<_>>().join(" ")
}

/// Everything that a pixel did.
pub(super) fn inspection(ui: &mut Ui, inspection: &Inspection) {
    let Inspection { rays, chords, shadows, taps, class, raw, filtered, .. } = inspection;
    if inspection.surface.is_none() {
        ui.label("The pixel sees no surface: it has no rays.");
        return;
    }
    ui.label(format!(
        "{} rays of all types, sample class {class}; openness {:.4} before the filter, {:.4} after it",
        inspection.ray_count(),
        raw.x,
        filtered.x
    ));
    list(ui, "Rays", rays.len(), |i| {
        let ray = &rays[i];
        let radiance = ray.hit.map_or_else(String::new, |hit| {
            let [r, g, b] = hit.radiance.to_array();
            format!(", radiance {r:.3} {g:.3} {b:.3}, instance {}", hit.instance)
        });
        let kind = if ray.hit.is_some() { Kind::Hit } else { Kind::Miss };
        (format!("{i:>4}  {ray}{radiance}"), kind)
    });
    list(ui, "Chords", chords.len(), |i| {
        let kind = if chords[i].blocked > 0.0 { Kind::Blocked } else { Kind::Chord };
        (format!("{i:>4}  {}", chords[i]), kind)
    });
    list(ui, "Shadow rays", shadows.len(), |i| {
        let kind = if shadows[i].blocked { Kind::Shadow } else { Kind::Light };
        (format!("{i:>4}  {}", shadows[i]), kind)
    });
    if !taps.is_empty() {
        let accepted = taps.iter().filter(|tap| tap.verdict.is_accepted()).count();
        let title = format!("Filter taps: {accepted} of {} accepted", taps.len());
        egui::CollapsingHeader::new(title)
            .id_salt("taps")
            .default_open(true)
            .show(ui, |ui| window_of(ui, taps));
    }
}

/// A list of lines, of which only those in sight are made.
fn list(ui: &mut Ui, title: &str, count: usize, line: impl Fn(usize) -> (String, Kind)) {
    if count == 0 {
        return;
    }
    let header = egui::CollapsingHeader::new(format!("{title} ({count})")).id_salt(title);
    header.default_open(count <= 64).show(ui, |ui| {
        let height = ui.text_style_height(&TextStyle::Monospace);
        let area = ScrollArea::both().id_salt(title).max_height(LIST).auto_shrink([false, true]);
        area.show_rows(ui, height, count, |ui, rows| {
            for i in rows {
                let (text, kind) = line(i);
                // One row each: the list counts on rows of equal height.
                ui.add(Label::new(RichText::new(text).monospace().color(kind.color())).extend());
            }
        });
    });
}

/// The filter's window, magnified: green what it accepts, red what it refuses, with the reason on hover.
fn window_of(ui: &mut Ui, taps: &[Tap]) {
    let ends = |axis: usize| {
        let offsets = taps.iter().map(move |tap| tap.offset[axis]);
        (offsets.clone().min().unwrap_or(0), offsets.max().unwrap_or(0))
    };
    let ((left, right), (top, bottom)) = (ends(0), ends(1));
    let size = TAP * vec2((right - left + 1) as f32, (bottom - top + 1) as f32);
    let (place, _) = ui.allocate_exact_size(size, Sense::hover());
    for tap in taps {
        let [dx, dy] = tap.offset;
        let corner = place.min + TAP * vec2((dx - left) as f32, (dy - top) as f32);
        let cell = egui::Rect::from_min_size(corner, Vec2::splat(TAP)).shrink(1.0);
        let response = ui.interact(cell, ui.id().with(("tap", dx, dy)), Sense::hover());
        let kind = if tap.verdict.is_accepted() { Kind::Accepted } else { Kind::Refused };
        let openness = tap.value.map_or(0.0, |value| value.x.clamp(0.0, 1.0));
        ui.painter().rect_filled(cell, 2.0, Color32::from_gray((255.0 * openness) as u8));
        let stroke = egui::Stroke::new(if (dx, dy) == (0, 0) { 3.0 } else { 1.5 }, kind.color());
        ui.painter().rect_stroke(cell, 2.0, stroke, StrokeKind::Inside);
        let openness = tap.value.map_or_else(String::new, |value| format!("\nopenness {:.4}", value.x));
        response.on_hover_text(format!("{tap}{openness}"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_stand_in_columns() {
        assert_eq!(numbers(&[0.5, -1.0, f32::INFINITY]), "   0.5000        -1       inf");
    }
}
