//! Editors of single settings, by the kind of their values. They read and give the spelling of the command line.

use ambray::settings::{Field, Kind, Settings};
use egui::{Button, Color32, DragValue, Id, Response, Slider, SliderClamping, TextEdit, Ui};

use super::{
    places::{self, PART_GAP, PATCH},
    scale::{self, Extent, Scale},
};
use crate::panels::refusal;

/// A setting that is being edited.
#[derive(Debug)]
pub(crate) struct Editor<'a> {
    /// Which.
    pub(crate) field: &'static Field,
    /// Its value; `auto` is replaced by what it became.
    pub(crate) text: &'a str,
    /// The settings that it is one of: they may not allow every value.
    pub(crate) settings: &'a Settings,
    /// The scene's extent.
    pub(crate) extent: Extent,
    /// Names to choose from, for settings that name things of the scene.
    pub(crate) names: &'a [String],
    /// The label that names the editor.
    pub(crate) label: Id,
}

/// What an editor did.
#[derive(Debug, Default)]
pub(crate) struct Edit {
    /// The new value.
    pub(crate) text: Option<String>,
    /// Whether it is being dragged.
    pub(crate) is_dragged: bool,
}

impl Edit {
    fn of(response: &Response, text: impl FnOnce() -> String) -> Self {
        Self { text: response.changed().then(text), is_dragged: response.dragged() }
    }
}

impl Editor<'_> {
    /// Draws the editor over the rest of the row.
    pub(crate) fn show(&self, ui: &mut Ui) -> Edit {
        match self.field.kind {
            Kind::Whole => self.whole(ui),
            Kind::Number | Kind::AutoNumber => self.number(ui),
            Kind::Flag => self.flag(ui),
            Kind::Choice(choices) => self.choice(ui, choices),
            Kind::Size => self.parts(ui, 'x', 2, 1.0),
            Kind::Rgb | Kind::AutoRgb => self.color(ui),
            Kind::AutoTriple => self.parts(ui, ',', 3, f64::from(self.extent.diagonal) * 2e-3),
            Kind::AutoRange => self.parts(ui, ',', 2, 0.01),
            Kind::AutoText => self.name(ui),
        }
    }

    fn whole(&self, ui: &mut Ui) -> Edit {
        let mut value: u32 = self.text.parse().unwrap_or_default();
        let response = match scale::of(self.field.name) {
            Some(scale) => {
                let range = scale.range(self.extent);
                let range = *range.start() as u32..=*range.end() as u32;
                slider(ui, Slider::new(&mut value, range).logarithmic(scale.is_logarithmic()))
            }
            None => ui.add_sized(full_row(ui), DragValue::new(&mut value).speed(0.2)),
        };
        Edit::of(&response.labelled_by(self.label), || value.to_string())
    }

    fn number(&self, ui: &mut Ui) -> Edit {
        let mut value: f32 = self.text.parse().unwrap_or_default();
        let unit = scale::unit(self.field.value_name);
        let response = match scale::of(self.field.name) {
            Some(scale) => {
                let range = scale.range(self.extent);
                let smallest = f64::from(range.start().abs().max(1e-6));
                let mut made = Slider::new(&mut value, range).suffix(unit).max_decimals(6);
                if scale.is_logarithmic() {
                    made = made.logarithmic(true).smallest_positive(smallest);
                }
                if matches!(scale, Scale::Linear(..) | Scale::OfAnimation) {
                    made = made.max_decimals(3);
                }
                slider(ui, made)
            }
            None => ui.add_sized(full_row(ui), DragValue::new(&mut value).speed(0.01).suffix(unit)),
        };
        Edit::of(&response.labelled_by(self.label), || value.to_string())
    }

    fn flag(&self, ui: &mut Ui) -> Edit {
        let mut value = self.text == "true";
        let response = ui.checkbox(&mut value, "");
        // A box without words would say that it has no name, whatever it is labelled by.
        let name = super::title(self.field);
        response.widget_info(|| egui::WidgetInfo::selected(egui::WidgetType::Checkbox, true, value, &name));
        Edit::of(&response.labelled_by(self.label), || value.to_string())
    }

    fn choice(&self, ui: &mut Ui, choices: &[(&str, &str)]) -> Edit {
        let mut chosen = None;
        let combo = egui::ComboBox::from_id_salt(self.field.name)
            .width(ui.available_width())
            .truncate()
            .selected_text(self.text)
            .show_ui(ui, |ui| {
                for (name, meaning) in choices {
                    let is_chosen = *name == self.text;
                    let refusal = refusal::of_choice(self.settings, self.field.name, name);
                    let label = Button::selectable(is_chosen, *name);
                    let label = ui.add_enabled(is_chosen || refusal.is_none(), label);
                    let label = label.on_hover_text(*meaning);
                    if label.on_disabled_hover_text(refusal.unwrap_or_default()).clicked() {
                        chosen = Some((*name).to_owned());
                    }
                }
            });
        let meaning = choices.iter().find(|(name, _)| *name == self.text).map_or("", |(_, meaning)| meaning);
        combo.response.on_hover_text(meaning).labelled_by(self.label);
        Edit { text: chosen, is_dragged: false }
    }

    /// Numbers beside each other.
    fn parts(&self, ui: &mut Ui, separator: char, count: usize, speed: f64) -> Edit {
        let mut parts: Vec<f64> =
            self.text.split(separator).map(|part| part.parse().unwrap_or_default()).collect();
        parts.resize(count, 0.0);
        let mut edit = Edit::default();
        let mut is_changed = false;
        let whole = self.field.kind == Kind::Size;
        ui.spacing_mut().button_padding.x = 3.0;
        for (part, place) in parts.iter_mut().zip(places::beside(ui.available_rect_before_wrap(), count)) {
            ui.spacing_mut().interact_size.x = place.width();
            let decimals = match place.width() {
                _ if whole => 0,
                ..44.0 => 2,
                _ => 4,
            };
            let drag = DragValue::new(part).speed(speed).max_decimals(decimals);
            let drag = if whole { drag.range(1.0..=32_768.0) } else { drag };
            let response = ui.put(place, drag).labelled_by(self.label);
            is_changed |= response.changed();
            edit.is_dragged |= response.dragged();
        }
        if is_changed {
            // Through single precision, so that the spelling is the value's.
            let words: Vec<_> = parts.iter().map(|part| (*part as f32).to_string()).collect();
            edit.text = Some(words.join(&separator.to_string()));
        }
        edit
    }

    /// A patch that opens a picker, and the three numbers.
    fn color(&self, ui: &mut Ui) -> Edit {
        let mut rgb = [0.0_f32; 3];
        for (channel, part) in rgb.iter_mut().zip(self.text.split(',')) {
            *channel = part.parse().unwrap_or_default();
        }
        let before = rgb;
        ui.spacing_mut().interact_size.x = PATCH;
        ui.spacing_mut().item_spacing.x = PART_GAP;
        let patch = ui.color_edit_button_rgb(&mut rgb).on_hover_text("linear light");
        if patch.changed() && rgb != before {
            let words: Vec<_> = rgb.iter().map(|v| v.max(0.0).to_string()).collect();
            return Edit { text: Some(words.join(",")), is_dragged: false };
        }
        self.parts(ui, ',', 3, 0.005)
    }

    /// A name of the scene, or any text.
    fn name(&self, ui: &mut Ui) -> Edit {
        if !self.names.is_empty() {
            let names: Vec<_> = self.names.iter().map(|name| (name.as_str(), "")).collect();
            return self.choice(ui, &names);
        }
        let mut text = self.text.to_owned();
        let field = TextEdit::singleline(&mut text).desired_width(f32::INFINITY);
        let field = field.hint_text(self.field.value_name).text_color(Color32::from_gray(210));
        let response = ui.add(field).labelled_by(self.label);
        Edit::of(&response, || text)
    }
}

fn full_row(ui: &Ui) -> [f32; 2] {
    [ui.available_width(), ui.spacing().interact_size.y]
}

/// A slider as wide as the row, with its number in a column of its own.
fn slider(ui: &mut Ui, slider: Slider<'_>) -> Response {
    let number = if ui.available_width() < 140.0 { 54.0 } else { 66.0 };
    ui.spacing_mut().interact_size.x = number;
    ui.spacing_mut().button_padding.x = 4.0;
    ui.spacing_mut().slider_width = (ui.available_width() - number - ui.spacing().item_spacing.x).max(24.0);
    ui.add(slider.clamping(SliderClamping::Never))
}
