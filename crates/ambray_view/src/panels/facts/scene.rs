//! What the scene is, and what its loader had to say.

use egui::{Label, RichText, Ui};

use crate::panels::{Desk, look};

pub(super) fn show(ui: &mut Ui, desk: &mut Desk<'_>) {
    let Some(opened) = &desk.shown.opened else {
        ui.weak("No scene is open");
        return;
    };
    look::fact(ui, "triangles", look::count(opened.build.triangles));
    look::fact(ui, "instances", look::count(opened.build.instances));
    look::fact(ui, "cameras", opened.cameras.len().to_string());
    look::fact(ui, "animations", opened.animations.len().to_string());
    let (low, high) = opened.bounds;
    let size = high - low;
    look::fact(ui, "size", format!("{:.2} \u{d7} {:.2} \u{d7} {:.2}", size.x, size.y, size.z));
    look::fact(ui, "read in", format!("{:.1} ms", 1e3 * opened.load_time.as_secs_f64()));
    look::fact(ui, "built in", format!("{:.1} ms", 1e3 * opened.build.build_time.as_secs_f64()));
    if let Some(rendered) = &desk.shown.sides[0] {
        look::fact(ui, "camera", &rendered.view.camera_origin);
        look::fact(ui, "lights", rendered.view.lights.len().to_string());
    }
    for warning in &opened.warnings {
        ui.add(Label::new(RichText::new(warning).color(look::WARNING).small()).wrap());
    }
}
