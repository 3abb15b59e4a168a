//! The canvas: the picture with everything that is drawn on it and done in it.

mod cross;
mod inspector;
mod keys;
mod labels;
mod navigation;
mod pictures;
mod placement;
mod split;
mod textures;

#[cfg(test)]
mod tests;

use ambray::settings::Size;
use egui::{
    CentralPanel, CursorIcon, Key, Modifiers, PointerButton, Rect, Response, Sense, Ui, WidgetInfo,
    WidgetType,
};
use glam::Vec3;

use crate::{
    app::Shown,
    camera::Viewpoint,
    engine::{Engine, Rendered},
    model::{Comparison, Model, Resolution, Side},
};
use inspector::Inspector;
use navigation::{Navigation, Surroundings, pressed};
use pictures::{Pictures, frame_of};
use placement::{Fit, Placement, Zoom};

pub use keys::{ACTIONS, Action};
pub use textures::{PictureTextures, Scaling};

/// State of the canvas from frame to frame.
#[derive(Debug, Default)]
pub struct Canvas {
    pictures: Pictures,
    zoom: Zoom,
    navigation: Navigation,
    inspector: Inspector,
    /// Whether the camera moved in the last frame.
    was_moving: bool,
}

impl Canvas {
    /// Says who knows the textures of pictures that stay on a device.
    pub fn set_textures(&mut self, textures: Box<dyn PictureTextures>) {
        self.pictures.set_textures(textures);
    }

    /// Draws the canvas into the rest of `ui`.
    pub fn show(&mut self, ui: &mut Ui, model: &mut Model, shown: &mut Shown, engine: &Engine) {
        CentralPanel::no_frame().show(ui, |ui| self.show_inside(ui, model, shown, engine));
    }

    fn show_inside(&mut self, ui: &mut Ui, model: &mut Model, shown: &mut Shown, engine: &Engine) {
        let scale = ui.ctx().pixels_per_point();
        let canvas = placement::aligned(ui.max_rect(), scale);
        let response = ui.allocate_rect(canvas, Sense::click_and_drag());
        response.widget_info(|| WidgetInfo::labeled(WidgetType::Image, true, "picture"));
        let size = picture_size(model.resolution, canvas.size() * scale);
        for side in Side::ALL {
            model.of_mut(side).size = size;
        }
        let fit = match model.resolution {
            Resolution::Window(_) => Fit::Fill,
            Resolution::Fixed(_) => Fit::Keep,
        };
        let takes_keys = !ui.ctx().egui_wants_keyboard_input();
        self.magnify(ui, &response, takes_keys, &Placement::new(canvas, scale, size, fit, &self.zoom));
        let placement = Placement::new(canvas, scale, size, fit, &self.zoom);
        self.move_camera(ui, &response, takes_keys, model, shown, &placement);

        self.pictures.paint(ui, model, shown, &placement);
        if model.comparison == Comparison::Split {
            model.divider = split::drag(ui, canvas, model.divider, takes_keys);
        }
        if !model.has_overlays {
            return;
        }
        if model.comparison == Comparison::Split {
            split::paint(ui.painter(), canvas, split::place(canvas, model.divider, scale));
        }
        pictures::label(ui.painter(), canvas, model, shown);
        if !self.zoom.is_whole() {
            labels::zoom(ui.painter(), canvas, self.zoom.factor());
        }
        self.cross(ui, canvas, model, shown);
        self.inspector.show(ui, &response, takes_keys, (model, shown, engine), &placement);
    }

    /// Zoom into the pixels of the picture.
    fn magnify(&mut self, ui: &Ui, response: &Response, takes_keys: bool, placement: &Placement) {
        let (factor, ctrl) = ui.input(|input| (input.zoom_delta(), input.modifiers.command));
        if let Some(pointer) = response.hover_pos()
            && factor != 1.0
        {
            self.zoom.magnify(placement, factor, pointer);
        }
        if ctrl && !self.zoom.is_whole() {
            let drags = [PointerButton::Primary, PointerButton::Middle];
            if drags.into_iter().any(|button| response.dragged_by(button)) {
                self.zoom.pan(placement, response.drag_delta());
            }
            if response.hovered() {
                ui.ctx().set_cursor_icon(CursorIcon::Grab);
            }
        }
        if takes_keys && ui.input_mut(|input| pressed(input, Modifiers::NONE, Key::Num0)) {
            self.zoom = Zoom::default();
        }
    }

    fn move_camera(
        &mut self,
        ui: &Ui,
        response: &Response,
        takes_keys: bool,
        model: &mut Model,
        shown: &Shown,
        placement: &Placement,
    ) {
        let mut is_moving = false;
        if let Some(viewpoint) = viewpoint(model, shown) {
            let size = model.of(Side::A).size;
            let around = Surroundings {
                bounds: shown.opened.as_ref().map(|opened| opened.bounds).unwrap_or_default(),
                aspect: size.width as f32 / size.height as f32,
                takes_keys,
                point_at: &|place| point_at(model, shown, placement, place),
            };
            let moved = self.navigation.step(ui, response, viewpoint, &around);
            is_moving = moved.is_moving;
            if let Some(to) = moved.to {
                put(to, model);
            }
        }
        // Others may say that something moves, too: only what was said here is taken back.
        if is_moving || self.was_moving {
            model.is_moving = is_moving;
        }
        self.was_moving = is_moving;
    }

    fn cross(&mut self, ui: &Ui, canvas: Rect, model: &mut Model, shown: &Shown) {
        let Some(rendered) = &shown.sides[0] else { return };
        if let Some(view) = cross::show(ui, canvas, &rendered.view.camera)
            && let Some(from) = viewpoint(model, shown)
        {
            // The camera is put where it is, so that whether it is still there can be told in the next frame.
            put(from, model);
            self.navigation.go(from, from.along(view));
            ui.ctx().request_repaint();
        }
    }
}

/// Places the camera of both sides.
fn put(viewpoint: Viewpoint, model: &mut Model) {
    for side in Side::ALL {
        viewpoint.apply(model.of_mut(side));
    }
}

/// Size of the picture in a canvas of `room` pixels of the window.
fn picture_size(resolution: Resolution, room: egui::Vec2) -> Size {
    match resolution {
        Resolution::Fixed(size) => size,
        Resolution::Window(factor) => {
            let largest = f32::from(i16::MAX as u16 + 1);
            // The settings allow 2^28 pixels in all.
            let fits = (2f32.powi(28) / (room.x * room.y * factor * factor)).sqrt().min(1.0);
            let side = |length: f32| (length * factor * fits).round().clamp(1.0, largest) as u32;
            Size { width: side(room.x), height: side(room.y) }
        }
    }
}

/// Where the camera is; `None` while that is not known: before the first picture of the scene, and with another camera of
/// the file.
fn viewpoint(model: &Model, shown: &Shown) -> Option<Viewpoint> {
    if shown.is_stale[0] {
        return None;
    }
    let settings = model.of(model.editing);
    let rendered = shown.sides[0].as_ref()?;
    (rendered.settings.camera == settings.camera)
        .then(|| Viewpoint::current(settings, &rendered.view, target_distance(rendered, shown)))
}

/// How far away the target of a camera is that has none: what is seen in the middle, else the middle of the scene.
fn target_distance(rendered: &Rendered, shown: &Shown) -> f32 {
    let in_the_middle = frame_of(rendered).and_then(|frame| {
        let middle = (frame.height / 2) as usize * frame.width as usize + (frame.width / 2) as usize;
        frame.gbuffer.get(middle).map(|pixel| pixel.depth)
    });
    let (low, high) = shown.opened.as_ref().map(|opened| opened.bounds).unwrap_or_default();
    let to_scene = rendered.view.camera.depth(0.5 * (low + high)).max(0.1 * low.distance(high));
    let usable = |distance: &f32| distance.is_finite() && *distance > 0.0;
    in_the_middle.filter(usable).or(Some(to_scene)).filter(usable).unwrap_or(1.0)
}

/// The side whose picture is shown at a place of the window.
fn side_at(model: &Model, placement: &Placement, place: egui::Pos2) -> Side {
    let divider = split::place(placement.canvas, model.divider, placement.pixels_per_point());
    if model.comparison == Comparison::Split { split::side_at(place.x, divider) } else { Side::A }
}

/// World position of what is seen at a place of the window.
fn point_at(model: &Model, shown: &Shown, placement: &Placement, place: egui::Pos2) -> Option<Vec3> {
    let side = side_at(model, placement, place);
    let frame = frame_of(shown.sides[side as usize].as_ref()?)?;
    let (x, y) = placement.pixel_at(place, (frame.width, frame.height))?;
    let pixel = frame.gbuffer[y as usize * frame.width as usize + x as usize];
    pixel.is_surface().then_some(pixel.position)
}
