//! One setting: dot, name, editor, `auto`.

use ambray::settings::{Field, Kind, Settings};
use egui::{Color32, Label, RichText, Sense, Ui};

use super::{
    Context, became,
    editor::{Edit, Editor},
    is_changed,
    places::{self, Places},
    reset,
    scale::Extent,
    side_mark, title,
};
use crate::{
    model::Resolution,
    panels::{Desk, look, refusal},
};

/// What is known of a setting in this frame.
pub(super) struct Row {
    field: &'static Field,
    extent: Extent,
    text: String,
    became: Option<String>,
    names: Vec<String>,
    differs: bool,
}

impl Row {
    pub(super) fn new(desk: &Desk<'_>, extent: Extent, field: &'static Field) -> Self {
        let model = &*desk.model;
        let (side, opened) = (model.editing, desk.shown.opened.as_deref());
        let rendered = desk.shown.sides[side as usize].as_ref();
        let names = match (field.name, opened) {
            ("camera", Some(opened)) => opened.cameras.iter().map(|camera| camera.name.clone()).collect(),
            ("animation", Some(opened)) => {
                opened.animations.iter().map(|animation| animation.name.clone()).collect()
            }
            _ => Vec::new(),
        };
        let text = model.edited().get(field.name).unwrap_or_default();
        let other = model.of(side.other()).get(field.name);
        Self {
            field,
            extent,
            became: if text == "auto" { became::value(field.name, rendered, opened) } else { None },
            differs: model.sides().len() == 2 && other.as_ref() != Some(&text),
            text,
            names,
        }
    }

    fn has_auto(&self) -> bool {
        self.field.kind.has_auto()
    }

    fn is_auto(&self) -> bool {
        self.has_auto() && self.text == "auto"
    }

    /// A value to begin with where `auto` became nothing that could be spelled.
    fn start(&self) -> String {
        if let Some(became) = &self.became {
            return became.clone();
        }
        match (self.field.kind, self.field.name) {
            (_, "camera-up" | "sun-direction") => "0.4,1,0.3".to_owned(),
            (Kind::AutoNumber, "vertical-fov") => "50".to_owned(),
            (Kind::AutoNumber, _) => (0.1 * self.extent.diagonal).to_string(),
            (Kind::AutoRgb, _) => "1,1,1".to_owned(),
            (Kind::AutoTriple, _) => "0,0,0".to_owned(),
            (Kind::AutoRange, _) => "0,1".to_owned(),
            _ => String::new(),
        }
    }

    pub(super) fn show(&self, ui: &mut Ui, desk: &mut Desk<'_>, context: &Context) {
        let field = self.field;
        let edit = ui.push_id(field.name, |ui| self.widgets(ui, desk, context)).inner;
        desk.is_dragging |= edit.is_dragged;
        if let Some(text) = edit.text {
            // What cannot be read is no value yet: the old one stays.
            let _ = desk.model.edited_mut().set(field.name, &text);
            if field.name == "size" {
                desk.model.resolution = Resolution::Fixed(desk.model.edited().size);
            }
        }
        for problem in context.problems.iter().filter(|problem| problem.name == field.name) {
            let text = format!("{} is not allowed: {}", problem.value, problem.allowed);
            ui.horizontal(|ui| {
                ui.add_space(16.0);
                ui.add(Label::new(RichText::new(text).color(look::ERROR).small()).wrap());
            });
        }
        if field.name == "method" {
            method_alone(ui, desk);
        }
    }

    fn widgets(&self, ui: &mut Ui, desk: &mut Desk<'_>, context: &Context) -> Edit {
        let field = self.field;
        let places = Places::of(ui.available_width(), ui.spacing().interact_size.y, field.kind);
        let (_, row) = ui.allocate_space(places.row.size());
        let places = places.at(row.min);
        let default = context.defaults.get(field.name).unwrap_or_default();
        let name = title(field);
        look::inside(ui, places.dot, |ui| self.dot(ui, desk, context, &name, &default));
        let label = look::inside(ui, places.name, |ui| self.label(ui, desk, &name, &default));
        let (text, is_auto) = (if self.is_auto() { self.start() } else { self.text.clone() }, self.is_auto());
        let settings = desk.model.edited();
        let editor = Editor { field, text: &text, settings, extent: self.extent, names: &self.names, label };
        let mut edit = look::inside(ui, places.editor, |ui| {
            if is_auto {
                ui.visuals_mut().override_text_color = Some(Color32::from_gray(128));
            }
            editor.show(ui)
        });
        if let Some(place) = places.auto {
            let word = if places::says_auto(row.width()) { "auto" } else { "" };
            edit.text = look::inside(ui, place, |ui| self.auto(ui, &name, word)).or(edit.text);
        }
        edit
    }

    /// The dot of a changed setting, that resets it.
    fn dot(&self, ui: &mut Ui, desk: &mut Desk<'_>, context: &Context, name: &str, default: &str) {
        let is_changed = is_changed(desk.model, &context.defaults, self.field);
        let dot = look::dot(ui, is_changed.then_some(look::ACCENT), &format!("reset {name}"));
        if !is_changed {
            return;
        }
        let before = if self.field.name == "size" { "that of the window" } else { default };
        if dot.on_hover_text(format!("Changed from {before}. Click to reset.")).clicked() {
            reset(desk.model, self.field);
        }
    }

    fn label(&self, ui: &mut Ui, desk: &Desk<'_>, name: &str, default: &str) -> egui::Id {
        let mut text = RichText::new(name);
        if self.differs
            && let Some((_, color)) = side_mark(desk)
        {
            text = text.color(color);
        }
        let label = Label::new(text).truncate().show_tooltip_when_elided(false).selectable(false);
        ui.add(label.sense(Sense::hover())).on_hover_ui(|ui| self.tooltip(ui, default)).id
    }

    fn tooltip(&self, ui: &mut Ui, default: &str) {
        let field = self.field;
        ui.set_max_width(360.0);
        ui.label(field.doc);
        if let Kind::Choice(choices) = field.kind {
            for (name, meaning) in choices {
                ui.label(RichText::new(format!("{name}: {meaning}")).weak());
            }
        }
        let allowed =
            if field.allowed.is_empty() { String::new() } else { format!("allowed: {}\n", field.allowed) };
        ui.label(
            RichText::new(format!("{allowed}default: {default}\n--{} {}", field.name, field.value_name))
                .monospace(),
        );
    }

    fn auto(&self, ui: &mut Ui, name: &str, word: &str) -> Option<String> {
        let mut is_auto = self.is_auto();
        let response = ui.checkbox(&mut is_auto, word).on_hover_text(match &self.became {
            Some(became) => format!("auto: chosen from the scene, {became}"),
            None => "auto: chosen from the scene".to_owned(),
        });
        response.widget_info(|| {
            egui::WidgetInfo::selected(egui::WidgetType::Checkbox, true, is_auto, format!("{name} auto"))
        });
        response.changed().then(|| if is_auto { "auto".to_owned() } else { self.start() })
    }
}

/// What the method that was chosen does not go with, and a button that resets it. The method is what was wanted last: the others
/// give way, but not unasked, since they would be missed by who goes back to another method.
fn method_alone(ui: &mut Ui, desk: &mut Desk<'_>) {
    let names: Vec<_> = refusal::by_method(desk.model.edited()).iter().map(|problem| problem.name).collect();
    if names.is_empty() {
        return;
    }
    let listed = refusal::listed(&names);
    ui.horizontal_wrapped(|ui| {
        ui.add_space(16.0);
        let text = format!("{} does not go with {listed}", desk.model.edited().method);
        ui.label(RichText::new(text).color(look::ERROR).small());
        if ui.small_button(format!("Reset {listed}")).clicked() {
            for field in Settings::fields().iter().filter(|field| names.contains(&field.name)) {
                reset(desk.model, field);
            }
        }
    });
}
