//! What hand and keys do to the camera.

use egui::{Event, Key, Modifiers, PointerButton, Pos2, Response, Ui, Vec2};
use glam::Vec3;

use crate::camera::{AxisView, Fly, Lens, Thrust, Transition, Viewpoint};

/// Turn for a drag over the height of the canvas, radians.
const TURN: f32 = std::f32::consts::PI;
/// Turn on the spot for a movement of the mouse over the height of the canvas, radians.
const LOOK: f32 = 1.6;
/// Longest time between two frames that counts, seconds: after a stall nothing jumps.
const LONGEST_STEP: f32 = 0.1;

/// What the camera does beyond a single frame.
#[derive(Debug, Default)]
pub(super) struct Navigation {
    fly: Option<Fly>,
    /// Bounds of the scene that the flight was made for.
    scene: Option<(Vec3, Vec3)>,
    /// A way that is being gone, and where it has led so far.
    transition: Option<(Transition, Viewpoint)>,
    /// Angle of view to come back to from parallel projection, degrees.
    fov: Option<f32>,
}

/// What the camera needs to know of the picture.
pub(super) struct Surroundings<'a> {
    /// Box around the scene.
    pub(super) bounds: (Vec3, Vec3),
    /// Width of the picture over its height.
    pub(super) aspect: f32,
    /// Whether keys are for the canvas.
    pub(super) takes_keys: bool,
    /// World position of what is seen at a place of the window.
    pub(super) point_at: &'a dyn Fn(Pos2) -> Option<Vec3>,
}

/// Where the camera is now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moved {
    /// The new viewpoint, if it is another one.
    pub(super) to: Option<Viewpoint>,
    /// Whether it goes on moving.
    pub(super) is_moving: bool,
}

impl Navigation {
    /// Begins a way to `to`.
    pub(super) fn go(&mut self, from: Viewpoint, to: Viewpoint) {
        self.transition = Some((Transition::new(from, to), from));
    }

    /// Applies what was done on `response`, the canvas, to the camera at `start`.
    pub(super) fn step(
        &mut self,
        ui: &Ui,
        response: &Response,
        start: Viewpoint,
        around: &Surroundings<'_>,
    ) -> Moved {
        if self.scene != Some(around.bounds) {
            (self.scene, self.fly) = (Some(around.bounds), None);
        }
        let mut now = start;
        let flying = self.fly(ui, response, &mut now);
        let dragging = self.drag(ui, response, &mut now) | (!flying && self.wheel(ui, response, &mut now));
        if flying || dragging {
            self.transition = None;
        } else {
            if around.takes_keys {
                self.keys(ui, now, around);
            }
            if response.double_clicked_by(PointerButton::Primary)
                && let Some(point) = response.interact_pointer_pos().and_then(around.point_at)
            {
                self.go(now, now.focused(point));
            }
        }
        let travelling = self.travel(ui, &mut now);
        if flying || travelling {
            ui.ctx().request_repaint();
        }
        Moved { to: (now != start).then_some(now), is_moving: flying || dragging || travelling }
    }

    fn drag(&self, ui: &Ui, response: &Response, now: &mut Viewpoint) -> bool {
        let modifiers = ui.input(|input| input.modifiers);
        let delta = response.drag_delta() / response.rect.height().max(1.0);
        let primary = response.dragged_by(PointerButton::Primary) && !modifiers.command && !modifiers.alt;
        let pans = response.dragged_by(PointerButton::Middle) && !modifiers.command;
        if pans || primary && modifiers.shift {
            *now = if delta == Vec2::ZERO { *now } else { now.panned(-delta.x, delta.y) };
        } else if primary && delta != Vec2::ZERO {
            *now = now.orbited(TURN * delta.x, TURN * delta.y);
        }
        pans || primary
    }

    fn wheel(&self, ui: &Ui, response: &Response, now: &mut Viewpoint) -> bool {
        let notches = if response.hovered() { notches(ui) } else { 0.0 };
        if notches != 0.0 {
            *now = now.dollied(notches);
        }
        notches != 0.0
    }

    fn fly(&mut self, ui: &Ui, response: &Response, now: &mut Viewpoint) -> bool {
        let bounds = self.scene.unwrap_or_default();
        let fly = self.fly.get_or_insert_with(|| Fly::through(bounds));
        let holds = response.is_pointer_button_down_on()
            && ui.input(|input| input.pointer.button_down(PointerButton::Secondary));
        if !holds {
            fly.stop();
            return false;
        }
        let (delta, thrust, dt) = ui.input(|input| {
            let axis = |plus, minus| {
                f32::from(u8::from(input.key_down(plus))) - f32::from(u8::from(input.key_down(minus)))
            };
            let thrust = Thrust {
                forward: axis(Key::W, Key::S),
                right: axis(Key::D, Key::A),
                up: axis(Key::E, Key::Q),
                fast: input.modifiers.shift,
            };
            // The raw movement goes on where the cursor is stopped by the edge of the screen.
            let delta = input.pointer.motion().unwrap_or_else(|| input.pointer.delta());
            (delta, thrust, input.stable_dt.min(LONGEST_STEP))
        });
        fly.accelerate(notches(ui));
        let turn = LOOK * delta / response.rect.height().max(1.0);
        if turn != Vec2::ZERO {
            *now = now.looked(turn.x, -turn.y);
        }
        *now = fly.step(*now, thrust, dt);
        true
    }

    fn keys(&mut self, ui: &Ui, now: Viewpoint, around: &Surroundings<'_>) {
        let pressed = |modifiers, key| ui.input_mut(|input| pressed(input, modifiers, key));
        if pressed(Modifiers::NONE, Key::F) {
            self.go(now, now.framed(around.bounds, around.aspect));
        }
        if pressed(Modifiers::NONE, Key::O) {
            let to = self.other_lens(now);
            self.go(now, to);
        }
        let axes = [
            (Key::X, AxisView::Right, AxisView::Left),
            (Key::Y, AxisView::Top, AxisView::Bottom),
            (Key::Z, AxisView::Front, AxisView::Back),
        ];
        for (key, view, opposite) in axes {
            if pressed(Modifiers::NONE, key) {
                self.go(now, now.along(view));
            } else if pressed(Modifiers::SHIFT, key) {
                self.go(now, now.along(opposite));
            }
        }
    }

    /// Perspective for orthographic and back.
    fn other_lens(&mut self, now: Viewpoint) -> Viewpoint {
        match now.lens {
            Lens::Perspective(degrees) => {
                self.fov = Some(degrees);
                now.orthographic()
            }
            Lens::Orthographic(_) => now.perspective(self.fov.unwrap_or(Lens::DEFAULT_FOV)),
        }
    }

    /// Goes on along the way, unless somebody else has put the camera elsewhere.
    fn travel(&mut self, ui: &Ui, now: &mut Viewpoint) -> bool {
        let Some((transition, reached)) = &mut self.transition else { return false };
        if *reached != *now {
            self.transition = None;
            return false;
        }
        *now = transition.step(ui.input(|input| input.stable_dt.min(LONGEST_STEP)));
        *reached = *now;
        if transition.is_over() {
            self.transition = None;
        }
        true
    }
}

/// Notches that the wheel was turned away from the user, with whatever modifier that does not magnify.
fn notches(ui: &Ui) -> f32 {
    let line = ui.ctx().options(|options| options.input_options.line_scroll_speed);
    let delta = ui.input(egui::InputState::smooth_scroll_delta);
    (delta.x + delta.y) / line.max(1.0)
}

/// Whether `key` was pressed with exactly `modifiers`, which nobody else may take for theirs then.
pub(super) fn pressed(input: &mut egui::InputState, modifiers: Modifiers, key: Key) -> bool {
    let exactly = |event: &Event| match event {
        Event::Key { key: other, pressed: true, modifiers: held, .. } => *other == key && *held == modifiers,
        _ => false,
    };
    let is_pressed = input.events.iter().any(exactly);
    input.events.retain(|event| !exactly(event));
    is_pressed
}
