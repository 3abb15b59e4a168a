//! The settings panel: every setting of `ambray render`, in its group, with what it means and a way back.

pub(crate) mod became;
mod editor;
mod header;
mod places;
mod row;
pub(crate) mod scale;

use ambray::settings::{Field, Settings, SettingsError};
use egui::{CollapsingHeader, RichText, ScrollArea, Ui, pos2, vec2};

use super::{Desk, look, refusal};
use crate::model::{Comparison, Model, Resolution, Side};
use row::Row;
use scale::Extent;

/// What the panel knows while it draws its rows.
struct Context {
    extent: Extent,
    defaults: Settings,
    problems: Vec<SettingsError>,
    search: String,
}

/// Draws the panel.
pub(super) fn show(ui: &mut Ui, desk: &mut Desk<'_>, search: &mut String) {
    header::show(ui, desk, search);
    let context = Context {
        extent: extent(desk),
        defaults: Settings::default(),
        problems: desk.model.edited().validate(),
        search: search.trim().to_lowercase(),
    };
    refusals(ui, desk, &context.problems);
    ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
        let mut fields = Settings::fields();
        while let Some(first) = fields.first() {
            let length = fields.iter().take_while(|field| field.heading == first.heading).count();
            let (group, rest) = fields.split_at(length);
            show_group(ui, desk, &context, group);
            fields = rest;
        }
    });
}

/// Why the edited side cannot be rendered. What is wrong with single values is said beside them, but their groups may be closed.
fn refusals(ui: &mut Ui, desk: &Desk<'_>, problems: &[SettingsError]) {
    let names: Vec<_> = problems.iter().map(|problem| problem.name).collect();
    if !names.is_empty() {
        let verb = if names.len() == 1 { "is" } else { "are" };
        let text = format!("The picture stays as it was: {} {verb} not allowed", refusal::listed(&names));
        ui.add(egui::Label::new(RichText::new(text).color(look::ERROR)).wrap());
    }
    for message in &desk.shown.refused[desk.model.editing as usize] {
        ui.add(egui::Label::new(RichText::new(message).color(look::ERROR)).wrap());
    }
}

fn extent(desk: &Desk<'_>) -> Extent {
    let Some(opened) = &desk.shown.opened else { return Extent::default() };
    let (low, high) = opened.bounds;
    let diagonal = (high - low).length();
    let durations = opened.animations.iter().map(|animation| animation.duration);
    let known = Extent::default();
    Extent {
        diagonal: if diagonal > 0.0 && diagonal.is_finite() { diagonal } else { known.diagonal },
        duration: durations.reduce(f32::max).unwrap_or(known.duration),
    }
}

fn show_group(ui: &mut Ui, desk: &mut Desk<'_>, context: &Context, group: &'static [Field]) {
    let heading = group[0].heading;
    let is_found = |field: &&Field| {
        let place = format!("{} {} {}", field.name, field.name.replace('-', " "), field.doc);
        context.search.is_empty() || place.to_lowercase().contains(&context.search)
    };
    let found: Vec<_> = group.iter().filter(is_found).collect();
    if found.is_empty() {
        return;
    }
    let changed: Vec<_> =
        group.iter().filter(|field| is_changed(desk.model, &context.defaults, field)).collect();
    let is_searching = !context.search.is_empty();
    let is_open = is_searching || desk.memory.panels.open_groups.contains(heading);
    let title = RichText::new(heading).strong();
    let shown = CollapsingHeader::new(title).id_salt(heading).open(Some(is_open)).show_unindented(ui, |ui| {
        for field in found {
            Row::new(desk, context.extent, field).show(ui, desk, context);
        }
        ui.add_space(4.0);
    });
    if shown.header_response.clicked() && !is_searching {
        desk.memory.panels.toggle_group(heading);
    }
    if !changed.is_empty() {
        reset_of_group(ui, desk, heading, &changed, shown.header_response.rect);
    }
}

/// A button at the right end of the header of a group.
fn reset_of_group(ui: &mut Ui, desk: &mut Desk<'_>, heading: &str, changed: &[&Field], header: egui::Rect) {
    let size = vec2(20.0, header.height());
    let rect = egui::Rect::from_min_size(pos2(ui.max_rect().right() - size.x, header.top()), size);
    let response = ui.interact(rect, ui.id().with(("reset", heading)), egui::Sense::click());
    response.widget_info(|| {
        egui::WidgetInfo::labeled(egui::WidgetType::Button, true, format!("reset {heading}"))
    });
    let radius = if response.hovered() { 4.5 } else { 3.0 };
    ui.painter().circle_filled(rect.center(), radius, look::ACCENT);
    let names: Vec<_> = changed.iter().map(|field| field.name).collect();
    let tip = format!("Changed: {}.\nClick to reset the group.", names.join(", "));
    if response.on_hover_text(tip).clicked() {
        for field in changed {
            reset(desk.model, field);
        }
    }
}

/// Whether a setting of the edited side is not as it is by itself; the size is by itself that of the window.
pub(super) fn is_changed(model: &Model, defaults: &Settings, field: &Field) -> bool {
    match field.name {
        "size" => matches!(model.resolution, Resolution::Fixed(_)),
        name => model.edited().get(name) != defaults.get(name),
    }
}

/// Gives a setting of the edited side its default.
pub(super) fn reset(model: &mut Model, field: &Field) {
    if field.name == "size" {
        model.resolution = Resolution::Window(1.0);
    } else if let Some(default) = Settings::default().get(field.name) {
        // The spelling of a value is always read.
        let _ = model.edited_mut().set(field.name, &default);
    }
}

/// The name of a setting as people read it.
pub(super) fn title(field: &Field) -> String {
    field.name.replace('-', " ")
}

/// Colour and letter of the side that is edited, where two are compared.
fn side_mark(desk: &Desk<'_>) -> Option<(Side, egui::Color32)> {
    let side = desk.model.editing;
    let color = match side {
        Side::A => look::SIDE_A,
        Side::B => look::SIDE_B,
    };
    (desk.model.comparison != Comparison::Off).then_some((side, color))
}
