//! Draws the pictures of both sides: one, both beside each other, or their difference.

use std::sync::Arc;

use ambray::Frame;
use egui::{Align2, Color32, Painter, Rect, Ui};

use super::{
    labels::{self, MARGIN},
    placement::Placement,
    split,
    textures::{self, HostTexture, PictureTextures, Scaling},
};
use crate::{
    app::Shown,
    engine::{Content, Rendered},
    model::{Comparison, Model, Side},
};

/// Colour around the picture.
const SURROUND: Color32 = Color32::from_gray(20);

/// The textures of the pictures.
#[derive(Debug, Default)]
pub(super) struct Pictures {
    sides: [HostTexture; 2],
    difference: HostTexture,
    /// Knows the pictures that stay on a device.
    on_device: Option<Box<dyn PictureTextures>>,
}

impl Pictures {
    pub(super) fn set_textures(&mut self, textures: Box<dyn PictureTextures>) {
        self.on_device = Some(textures);
    }

    /// Draws what is compared as `model` says.
    pub(super) fn paint(&mut self, ui: &Ui, model: &Model, shown: &Shown, placement: &Placement) {
        let painter = ui.painter().with_clip_rect(placement.canvas);
        painter.rect_filled(placement.canvas, 0.0, SURROUND);
        let mut side = |side: Side, part: Rect| {
            if let Some(rendered) = &shown.sides[side as usize] {
                self.paint_side(&painter.with_clip_rect(part), model, rendered, placement);
            }
        };
        match (model.comparison, &shown.difference) {
            (Comparison::Split, _) => {
                for which in Side::ALL {
                    side(which, part_of(model, placement, which));
                }
            }
            (Comparison::Difference, Some(difference)) => {
                let pixels = &difference.pixels;
                let scaling = scaling(model, (pixels.width, pixels.height), placement);
                self.difference.update(ui.ctx(), "difference", pixels, scaling);
                self.difference.paint(&painter, placement.picture);
            }
            _ => side(Side::A, placement.canvas),
        }
    }

    fn paint_side(&mut self, painter: &Painter, model: &Model, rendered: &Rendered, placement: &Placement) {
        let scaling = scaling(model, size_of(rendered), placement);
        match &rendered.content {
            Content::Host { pixels, .. } => {
                let texture = &mut self.sides[rendered.side as usize];
                texture.update(painter.ctx(), "picture", pixels, scaling);
                texture.paint(painter, placement.picture);
            }
            Content::Device { .. } => {
                let known = self.on_device.as_mut();
                if let Some(texture) = known.and_then(|known| known.texture(rendered, scaling)) {
                    textures::paint(painter, texture, placement.picture);
                }
            }
        }
    }
}

/// The part of the canvas that shows the picture of `side`.
pub(super) fn part_of(model: &Model, placement: &Placement, side: Side) -> Rect {
    if model.comparison != Comparison::Split {
        return placement.canvas;
    }
    let x = split::place(placement.canvas, model.divider, placement.pixels_per_point());
    split::parts(placement.canvas, x)[side as usize]
}

/// The planes of a picture, where the processor has them.
pub(super) fn frame_of(rendered: &Rendered) -> Option<&Frame> {
    shared_frame_of(rendered).map(AsRef::as_ref)
}

/// The same, to be kept.
pub(super) const fn shared_frame_of(rendered: &Rendered) -> Option<&Arc<Frame>> {
    match &rendered.content {
        Content::Host { frame, .. } => Some(frame),
        Content::Device { frame, .. } => frame.as_ref(),
    }
}

/// Width and height of a picture as it was rendered.
pub(super) fn size_of(rendered: &Rendered) -> (u32, u32) {
    rendered.view.camera.size()
}

/// Pictures at their size are shown pixel for pixel; previews, and what has to be made smaller, are blended.
fn scaling(model: &Model, size: (u32, u32), placement: &Placement) -> Scaling {
    let asked = model.of(Side::A).size;
    let is_whole = size == (asked.width, asked.height) && placement.scale() > 0.999;
    if is_whole { Scaling::Exact } else { Scaling::Smooth }
}

/// Writes what the pictures are at the edges of the canvas.
pub(super) fn label(painter: &Painter, canvas: Rect, model: &Model, shown: &Shown) {
    let painter = painter.with_clip_rect(canvas);
    let inner = canvas.shrink(MARGIN);
    let corners = [(inner.left_top(), Align2::LEFT_TOP), (inner.right_top(), Align2::RIGHT_TOP)];
    match (model.comparison, &shown.difference) {
        (Comparison::Off, _) => {}
        (Comparison::Split, _) => {
            for (text, (corner, anchor)) in labels::sides(&model.settings).iter().zip(corners) {
                labels::paint(&painter, corner, anchor, text);
            }
        }
        (Comparison::Difference, difference) => {
            let text = difference
                .as_ref()
                .map_or_else(|| "A \u{2212} B: waiting for both pictures".to_owned(), labels::difference);
            let place = labels::paint(&painter, inner.left_top(), Align2::LEFT_TOP, &text);
            let [a, b] = labels::sides(&model.settings);
            labels::paint(&painter, place.left_bottom(), Align2::LEFT_TOP, &format!("{a}   {b}"));
        }
    }
    let bottoms = [(inner.left_bottom(), Align2::LEFT_BOTTOM), (inner.center_bottom(), Align2::LEFT_BOTTOM)];
    for (&side, (corner, anchor)) in model.sides().iter().zip(bottoms) {
        let level = shown.sides[side as usize].as_ref().and_then(labels::level);
        if let Some(level) = level {
            let name = if model.sides().len() > 1 { format!("{side:?}: ") } else { String::new() };
            labels::paint(&painter, corner, anchor, &(name + &level));
        }
    }
}
