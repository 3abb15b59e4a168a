//! What can be dropped, shown while files are held over the window.

use egui::{Align2, Area, Color32, Context, FontId, Id, Order};

pub(super) fn show(ctx: &Context) {
    let is_hovered = ctx.input(|input| !input.raw.hovered_files.is_empty());
    if !is_hovered {
        return;
    }
    Area::new(Id::new("drop")).order(Order::Foreground).interactable(false).show(ctx, |ui| {
        let rect = ctx.content_rect();
        ui.painter().rect_filled(rect, 0.0, Color32::from_black_alpha(150));
        let text = "Drop a scene (glTF, OBJ) to open it,\nor settings (TOML, PNG, OpenEXR) to load them";
        let font = FontId::proportional(18.0);
        ui.painter().text(rect.center(), Align2::CENTER_CENTER, text, font, Color32::WHITE);
    });
}
