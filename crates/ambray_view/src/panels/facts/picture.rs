//! The values of the plane that is shown: histogram, exposure, and the difference of two pictures.

use ambray::{
    AovKind,
    settings::{Auto, Range},
};
use egui::{RichText, Slider, Ui};

use super::histogram::{self, Handles};
use crate::{
    model::{Comparison, Side},
    panels::{Desk, look},
};

pub(super) fn show(ui: &mut Ui, desk: &mut Desk<'_>) {
    if desk.model.comparison == Comparison::Difference {
        difference(ui, desk);
    }
    let side = if desk.model.comparison == Comparison::Off { Side::A } else { desk.model.editing };
    let statistics =
        desk.shown.sides[side as usize].as_ref().and_then(|rendered| rendered.statistics.clone());
    let aov = desk.model.aov;
    ui.horizontal(|ui| {
        ui.label(RichText::new(aov.name()).weak());
        let log = &mut desk.memory.panels.log_histogram;
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.checkbox(log, "log").on_hover_text("Count by factors, so that rare values are seen");
        });
    });
    let Some(statistics) = statistics else {
        ui.weak("The values follow when the picture is final");
        exposure(ui, desk);
        return;
    };
    let is_scalar = matches!(aov.kind(), AovKind::Unit | AovKind::Depth | AovKind::Count);
    let handles = is_scalar.then(|| match desk.model.edited().range {
        Auto::Value(Range([low, high])) => Handles { low, high },
        Auto::Auto => Handles { low: statistics.low, high: statistics.high },
    });
    let shown = histogram::show(ui, &statistics, desk.memory.panels.log_histogram, handles);
    desk.is_dragging |= shown.is_dragged;
    if let Some(Handles { low, high }) = shown.moved
        && low < high
    {
        desk.model.edited_mut().range = Auto::Value(Range([low, high]));
    }
    look::fact(ui, "least, largest", format!("{:.5}, {:.5}", statistics.low, statistics.high));
    let means: Vec<_> = statistics.mean.iter().map(|mean| format!("{mean:.5}")).collect();
    look::fact(ui, "mean", means.join(", "));
    if is_scalar {
        ui.horizontal(|ui| {
            let is_set = desk.model.edited().range != Auto::Auto;
            if ui.add_enabled(is_set, egui::Button::new("auto range")).clicked() {
                desk.model.edited_mut().range = Auto::Auto;
            }
            ui.add(egui::Label::new(RichText::new("drag the ends to set it").weak()).truncate());
        });
    }
    exposure(ui, desk);
}

fn exposure(ui: &mut Ui, desk: &mut Desk<'_>) {
    if desk.model.aov.kind() != AovKind::Color {
        return;
    }
    ui.horizontal(|ui| {
        let label = ui.label("exposure").id;
        let settings = desk.model.edited_mut();
        ui.spacing_mut().slider_width = (ui.available_width() - 116.0).max(60.0);
        let slider = Slider::new(&mut settings.exposure, -6.0..=6.0).suffix(" EV").max_decimals(2);
        let slider = ui.add(slider.clamping(egui::SliderClamping::Never));
        slider.widget_info(|| {
            egui::WidgetInfo::labeled(egui::WidgetType::Slider, true, "exposure of the picture")
        });
        desk.is_dragging |= slider.labelled_by(label).dragged();
        if ui.small_button("0").on_hover_text("Back to 0 EV").clicked() {
            desk.model.edited_mut().exposure = 0.0;
        }
    });
}

fn difference(ui: &mut Ui, desk: &Desk<'_>) {
    let Some(difference) = &desk.shown.difference else {
        ui.weak("The difference follows when both pictures are there");
        return;
    };
    look::fact(ui, "RMSE", format!("{:.6}", difference.rmse));
    look::fact(ui, "bias A \u{2212} B", format!("{:+.6}", difference.bias));
    look::fact(ui, "largest", format!("{:.6}", difference.largest));
    ui.separator();
}
