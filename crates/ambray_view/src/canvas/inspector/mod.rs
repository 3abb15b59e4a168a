//! The pixel inspector: values under the cursor, and what a pinned pixel did.

mod draw;
mod legend;
mod lines;
mod window;

use std::sync::Arc;

use ambray::Frame;
use egui::{Key, Modifiers, Pos2, Response, Ui};

use super::{
    navigation::pressed,
    pictures::{part_of, shared_frame_of},
    placement::Placement,
    side_at,
};
use crate::{
    app::Shown,
    engine::{Engine, Inspected, Rendered},
    model::{Model, Side},
};
use draw::Drawing;
use legend::Wanted;

/// Width of the window, points.
const WIDTH: f32 = 330.0;

/// A pixel of the picture of a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Pin {
    side: Side,
    pixel: (u32, u32),
}

/// State of the inspector from frame to frame.
#[derive(Debug, Default)]
pub(super) struct Inspector {
    /// The pixel whose rays are shown.
    pinned: Option<Pin>,
    /// What the engine was asked for last, and in which frame. The frame is kept, so that no other can come to lie at its
    /// address.
    asked: Option<(Pin, Arc<Frame>)>,
    wanted: Wanted,
}

impl Inspector {
    /// Takes clicks and keys on the canvas, draws on the picture, and shows the window.
    pub(super) fn show(
        &mut self,
        ui: &Ui,
        response: &Response,
        takes_keys: bool,
        (model, shown, engine): (&mut Model, &Shown, &Engine),
        placement: &Placement,
    ) {
        if takes_keys && ui.input_mut(|input| pressed(input, Modifiers::NONE, Key::I)) {
            model.is_inspecting = !model.is_inspecting;
        }
        if response.clicked() && ui.input(|input| input.modifiers.alt) {
            let place = response.interact_pointer_pos();
            self.pinned = place.and_then(|place| pixel_at(model, shown, placement, place));
            model.is_inspecting = true;
        }
        let lets_go = || ui.input_mut(|input| pressed(input, Modifiers::NONE, Key::Escape));
        if self.pinned.is_some() && (!model.is_inspecting || takes_keys && lets_go()) {
            self.pinned = None;
        }
        if model.is_inspecting {
            self.ask(model, shown, engine);
            self.draw(ui, model, shown, placement);
            self.window(ui, response, model, shown, placement);
        }
    }

    /// Asks what the pinned pixel did, once for every finished picture.
    fn ask(&mut self, model: &Model, shown: &Shown, engine: &Engine) {
        let Some(pin) = self.pinned else { return };
        let Some((rendered, frame)) = picture(shown, pin.side) else { return };
        let is_asked = |(asked, of): &(Pin, Arc<Frame>)| *asked == pin && Arc::ptr_eq(of, frame);
        let is_there = pin.pixel.0 < frame.width && pin.pixel.1 < frame.height;
        if rendered.level.is_final
            && rays_of_pixels(rendered).is_ok()
            && is_there
            && model.sides().contains(&pin.side)
            && !self.asked.as_ref().is_some_and(is_asked)
        {
            engine.inspect(pin.side, pin.pixel);
            self.asked = Some((pin, Arc::clone(frame)));
        }
    }

    fn draw(&self, ui: &Ui, model: &Model, shown: &Shown, placement: &Placement) {
        let Some(pin) = self.pinned else { return };
        let Some((_, frame)) = picture(shown, pin.side) else { return };
        let painter = ui.painter().with_clip_rect(part_of(model, placement, pin.side));
        let drawing = Drawing { painter: &painter, placement, frame };
        // What an older picture did would be drawn at the wrong place.
        let is_current =
            self.asked.as_ref().is_some_and(|(asked, of)| *asked == pin && Arc::ptr_eq(of, frame));
        match self.answer(shown).filter(|_| is_current) {
            Some(inspected) => drawing.inspection(&inspected.inspection, self.wanted),
            None => drawing.pixel(pin.pixel),
        }
    }

    /// The pixel that the engine was asked about last.
    #[cfg(test)]
    pub(super) fn asked(&self) -> Option<(u32, u32)> {
        self.asked.as_ref().map(|(pin, _)| pin.pixel)
    }

    /// What the pinned pixel did, once the engine has said so.
    fn answer<'a>(&self, shown: &'a Shown) -> Option<&'a Inspected> {
        let pin = self.pinned?;
        shown
            .inspected
            .as_deref()
            .filter(|inspected| (inspected.side, inspected.pixel) == (pin.side, pin.pixel))
    }

    fn window(
        &mut self,
        ui: &Ui,
        response: &Response,
        model: &mut Model,
        shown: &Shown,
        placement: &Placement,
    ) {
        let under_cursor = response.hover_pos().and_then(|place| pixel_at(model, shown, placement, place));
        let subject = self.pinned.or(under_cursor);
        let is_split = model.sides().len() > 1;
        let mut is_open = true;
        // Not over the pixel that opens it.
        let canvas = placement.canvas;
        let is_on_the_left = response.interact_pointer_pos().is_some_and(|place| place.x < canvas.center().x);
        let left = if is_on_the_left {
            (canvas.right() - WIDTH - 36.0).max(canvas.left())
        } else {
            canvas.left() + 16.0
        };
        egui::Window::new("Pixel inspector")
            .open(&mut is_open)
            .default_pos([left, canvas.top() + 48.0])
            .default_width(WIDTH)
            .default_height(0.6 * canvas.height())
            .vscroll(true)
            .show(ui.ctx(), |ui| {
                let Some((pin, rendered, frame)) = subject
                    .and_then(|pin| picture(shown, pin.side).map(|(rendered, frame)| (pin, rendered, frame)))
                else {
                    ui.label("Move the cursor over the picture. Alt+click inspects the rays of a pixel.");
                    return;
                };
                let (x, y) = pin.pixel;
                if x >= frame.width || y >= frame.height {
                    ui.label(format!("Pixel {x}, {y} is outside the picture as it is now."));
                    return;
                }
                ui.horizontal(|ui| {
                    let side = if is_split { format!("{:?}: ", pin.side) } else { String::new() };
                    ui.strong(format!("{side}pixel {x}, {y} of {} \u{d7} {}", frame.width, frame.height));
                    if self.pinned.is_some() && ui.button("Let go").on_hover_text("Esc").clicked() {
                        self.pinned = None;
                    }
                });
                // The rays of a pinned pixel are worth more room than its values.
                let values = egui::CollapsingHeader::new("Values").id_salt(("values", self.pinned.is_some()));
                let values = values.default_open(self.pinned.is_none());
                values.show(ui, |ui| window::values(ui, frame, pin.pixel));
                let rays = rays_of_pixels(rendered);
                if self.pinned.is_none() {
                    ui.weak(rays.err().as_deref().unwrap_or("Alt+click inspects the rays of a pixel."));
                    return;
                }
                ui.separator();
                ui.add_enabled_ui(rays.is_ok(), |ui| self.wanted.edit(ui));
                match (rays, self.answer(shown)) {
                    (Err(reason), _) => {
                        ui.weak(reason);
                    }
                    (Ok(()), Some(inspected)) => window::inspection(ui, &inspected.inspection),
                    (Ok(()), None) => {
                        ui.weak("Waiting for the finished picture.");
                    }
                }
            });
        model.is_inspecting = is_open;
    }
}

/// Whether it can be told what a pixel of the picture did; the error says why not.
fn rays_of_pixels(rendered: &Rendered) -> Result<(), String> {
    let method = rendered.settings.method;
    if method.is_screen_space() {
        return Err(format!("{method} works on whole pictures: there are no rays of a pixel to show."));
    }
    Ok(())
}

/// The picture of a side with its planes, where the processor has them.
fn picture(shown: &Shown, side: Side) -> Option<(&Rendered, &Arc<Frame>)> {
    let rendered = shown.sides[side as usize].as_ref()?;
    Some((rendered, shared_frame_of(rendered)?))
}

/// The pixel at a place of the window, of the picture that is shown there.
fn pixel_at(model: &Model, shown: &Shown, placement: &Placement, place: Pos2) -> Option<Pin> {
    let side = side_at(model, placement, place);
    let (_, frame) = picture(shown, side)?;
    let pixel = placement.pixel_at(place, (frame.width, frame.height))?;
    Some(Pin { side, pixel })
}
