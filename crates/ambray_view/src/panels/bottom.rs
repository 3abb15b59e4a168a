//! The bar at the bottom: the animation, and light that accumulates.

use ambray::settings::{Auto, Settings, Temporal};
use egui::{Button, Checkbox, ComboBox, DragValue, Label, RichText, Slider, Ui};

use super::{Desk, action::Action, look, refusal};

pub(super) fn show(ui: &mut Ui, desk: &mut Desk<'_>) {
    ui.add_space(1.0);
    ui.horizontal(|ui| {
        let durations: Vec<_> = desk
            .shown
            .opened
            .iter()
            .flat_map(|opened| &opened.animations)
            .map(|animation| (animation.name.clone(), animation.duration))
            .collect();
        let reason = match &desk.shown.opened {
            Some(_) if durations.is_empty() => "The scene has no animation",
            Some(_) => "",
            None => "No scene is open",
        };
        ui.add_enabled_ui(reason.is_empty(), |ui| transport(ui, desk, &durations))
            .response
            .on_disabled_hover_text(reason);
        ui.separator();
        accumulation(ui, desk);
        if !reason.is_empty() {
            ui.separator();
            ui.add(Label::new(RichText::new(reason).weak()).truncate());
        }
    });
    ui.add_space(1.0);
}

/// Length of the animation that `settings` choose.
#[must_use]
pub(crate) fn duration(settings: &Settings, animations: &[(String, f32)]) -> f32 {
    let chosen = match &settings.animation {
        Auto::Value(name) => animations
            .iter()
            .find(|(other, _)| other == name)
            .or_else(|| animations.get(name.parse::<usize>().ok()?)),
        Auto::Auto => animations.first(),
    };
    // All at once last as long as the longest.
    let longest = animations.iter().map(|(_, duration)| *duration).fold(0.0, f32::max);
    chosen.map_or(longest, |(_, duration)| *duration)
}

fn transport(ui: &mut Ui, desk: &mut Desk<'_>, animations: &[(String, f32)]) {
    let is_playing = desk.model.playback.is_playing;
    let button = Button::new(if is_playing { "Pause" } else { "Play" }).min_size(egui::vec2(48.0, 0.0));
    if ui.add(button).on_hover_text("Space").clicked() {
        desk.actions.push(Action::TogglePlay);
    }
    if ui.button("<").on_hover_text("Step back (,)").clicked() {
        desk.actions.push(Action::Step(-1));
    }
    if ui.button(">").on_hover_text("Step forward (.)").clicked() {
        desk.actions.push(Action::Step(1));
    }
    let settings = desk.model.edited_mut();
    let tip = "Start over after the end; otherwise the last pose holds";
    ui.checkbox(&mut settings.animation_loop, "loop").on_hover_text(tip);
    let length = duration(settings, animations);
    let mut time = settings.time.unwrap_or(0.0);
    ui.spacing_mut().slider_width = (ui.available_width() - 580.0).clamp(80.0, 900.0);
    let slider = Slider::new(&mut time, 0.0..=length.max(1e-3)).fixed_decimals(3).suffix(" s");
    let slider = ui.add(slider.clamping(egui::SliderClamping::Never));
    slider.widget_info(|| egui::WidgetInfo::slider(true, f64::from(time), "time in the animation"));
    desk.is_dragging |= slider.dragged();
    if slider.changed() {
        settings.time = Auto::Value(time.max(0.0));
    }
    if ui.button("Rest").on_hover_text("Show the scene at rest: time is auto").clicked() {
        settings.time = Auto::Auto;
        desk.model.playback.is_playing = false;
    }
    if animations.len() > 1 {
        picker(ui, desk.model.edited_mut(), animations);
    }
    let playback = &mut desk.model.playback;
    let speed =
        DragValue::new(&mut playback.speed).speed(0.01).range(0.01..=16.0).prefix("x ").max_decimals(2);
    ui.add(speed).on_hover_text("Seconds of the animation in a second");
    let fps = DragValue::new(&mut playback.fps).speed(0.1).range(1.0..=240.0).suffix(" fps").max_decimals(1);
    ui.add(fps).on_hover_text("Frames a second of a single step");
}

fn picker(ui: &mut Ui, settings: &mut Settings, animations: &[(String, f32)]) {
    let first = animations.first().map_or("", |(name, _)| name);
    let chosen = settings.animation.value().map_or(first, String::as_str).to_owned();
    let combo = ComboBox::from_id_salt("animation").width(96.0).selected_text(&chosen);
    combo.show_ui(ui, |ui| {
        for (name, duration) in animations {
            let label = ui.selectable_label(chosen == *name, name);
            if label.on_hover_text(format!("{duration:.2} s")).clicked() {
                settings.animation = Auto::Value(name.clone());
            }
        }
        let label = ui.selectable_label(chosen == "all", "all");
        if label.on_hover_text("All animations at once").clicked() {
            settings.animation = Auto::Value("all".to_owned());
        }
    });
}

fn accumulation(ui: &mut Ui, desk: &mut Desk<'_>) {
    let settings = desk.model.edited();
    let mut is_on = settings.temporal == Temporal::On;
    let refusal = refusal::of_choice(settings, "temporal", "on");
    let tip =
        "Light accumulates over frames: each continues the sample sequence and keeps what is still true";
    // What is on can always be switched off.
    let is_enabled = is_on || refusal.is_none();
    let response = ui.add_enabled(is_enabled, Checkbox::new(&mut is_on, "accumulate")).on_hover_text(tip);
    if response.on_disabled_hover_text(refusal.as_deref().unwrap_or_default()).changed() {
        desk.model.edited_mut().temporal = if is_on { Temporal::On } else { Temporal::Off };
    }
    let frames = desk.shown.sides[desk.model.editing as usize].as_ref().map_or(0, |rendered| rendered.frames);
    if let Some(reason) = refusal.filter(|_| is_on) {
        ui.label(RichText::new("not allowed").color(look::ERROR)).on_hover_text(reason);
    } else if is_on {
        let word = if frames == 1 { "frame" } else { "frames" };
        ui.label(RichText::new(format!("{frames:>3} {word}")).monospace());
    }
}
