//! Where to look from: the cameras of the file, bookmarks, the projection.

use ambray::{camera::Projection, settings::Auto};
use egui::{Button, Ui};

use super::{Desk, action::Action, became};
use crate::{
    camera::{Lens, Viewpoint},
    model::Bookmark,
};

pub(super) fn show(ui: &mut Ui, desk: &mut Desk<'_>) {
    let names: Vec<_> =
        desk.shown.opened.iter().flat_map(|opened| &opened.cameras).map(|c| c.name.clone()).collect();
    let settings = desk.model.edited_mut();
    let is_free = settings.camera_position.value().is_some();
    let is_automatic = !is_free && settings.camera == Auto::Auto;
    if ui
        .radio(is_automatic, "Automatic")
        .on_hover_text("The first camera of the file, or a view of the whole scene")
        .clicked()
    {
        Bookmark::default().apply(settings);
    }
    for name in names {
        let is_chosen = !is_free && settings.camera.value() == Some(&name);
        if ui.radio(is_chosen, &name).on_hover_text("A camera of the file").clicked() {
            Bookmark { camera: Auto::Value(name), ..Bookmark::default() }.apply(settings);
        }
    }
    ui.separator();
    projection(ui, desk);
    ui.separator();
    bookmarks(ui, desk);
}

fn projection(ui: &mut Ui, desk: &mut Desk<'_>) {
    let side = desk.model.editing as usize;
    let Some(rendered) = &desk.shown.sides[side] else { return };
    let view = &rendered.view;
    let is_orthographic = matches!(view.camera.projection(), Projection::Orthographic { .. });
    let depth = match desk.model.edited().camera_target.value() {
        Some(target) => view.camera.depth((*target).into()),
        None => view.camera.depth(became::target(view, desk.shown.opened.as_deref())),
    };
    let settings = desk.model.edited_mut();
    let from = Viewpoint::current(settings, view, depth);
    if ui.radio(!is_orthographic, "Perspective").clicked() && is_orthographic {
        from.perspective(Lens::DEFAULT_FOV).apply(settings);
    }
    if ui.radio(is_orthographic, "Orthographic").clicked() && !is_orthographic {
        from.orthographic().apply(settings);
    }
}

fn bookmarks(ui: &mut Ui, desk: &mut Desk<'_>) {
    let digits: Vec<u8> = desk.model.bookmarks.keys().copied().collect();
    for digit in digits {
        ui.horizontal(|ui| {
            let button = Button::new(format!("Bookmark {digit}")).shortcut_text(digit.to_string());
            if ui.add(button).clicked() {
                desk.actions.push(Action::Recall(digit));
            }
            if ui.small_button("x").on_hover_text("Forget this bookmark").clicked() {
                desk.model.bookmarks.remove(&digit);
            }
        });
    }
    let free = (1..=9).find(|digit| !desk.model.bookmarks.contains_key(digit));
    let Some(digit) = free else { return };
    let button = Button::new(format!("Keep as bookmark {digit}")).shortcut_text(format!("Shift+{digit}"));
    if ui.add(button).clicked() {
        desk.actions.push(Action::Keep(digit));
    }
}
