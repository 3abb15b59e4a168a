//! The divider between the pictures of both sides.

use egui::{Color32, CursorIcon, Id, Key, Modifiers, Painter, Rect, Sense, Stroke, Ui, pos2, vec2};

use crate::model::Side;

/// Half the width in which the divider can be grabbed, points.
const GRAB: f32 = 6.0;
/// How far an arrow key moves the divider, share of the width.
const STEP: f32 = 0.01;

/// Place of the divider in the window, points, on a whole pixel.
pub(super) fn place(canvas: Rect, divider: f32, pixels_per_point: f32) -> f32 {
    let x = canvas.left() + divider.clamp(0.0, 1.0) * canvas.width();
    (x * pixels_per_point).round() / pixels_per_point
}

/// The parts of the canvas that belong to A and to B.
pub(super) fn parts(canvas: Rect, x: f32) -> [Rect; 2] {
    [
        Rect::from_min_max(canvas.min, pos2(x, canvas.bottom())),
        Rect::from_min_max(pos2(x, canvas.top()), canvas.max),
    ]
}

/// The side at `x`.
pub(super) fn side_at(x: f32, divider: f32) -> Side {
    if x < divider { Side::A } else { Side::B }
}

/// Lets the user move the divider; gives its new place.
pub(super) fn drag(ui: &Ui, canvas: Rect, divider: f32, takes_keys: bool) -> f32 {
    let x = place(canvas, divider, ui.ctx().pixels_per_point());
    let area = Rect::from_min_max(pos2(x - GRAB, canvas.top()), pos2(x + GRAB, canvas.bottom()));
    let response = ui
        .interact(area.intersect(canvas), Id::new("divider"), Sense::click_and_drag())
        .on_hover_and_drag_cursor(CursorIcon::ResizeHorizontal);
    let mut divider = divider;
    if response.double_clicked() {
        divider = 0.5;
    } else if response.dragged()
        && let Some(pointer) = response.interact_pointer_pos()
    {
        divider = (pointer.x - canvas.left()) / canvas.width().max(1.0);
    }
    if takes_keys {
        divider += ui.input_mut(|input| {
            let mut step = |modifiers, step: f32| {
                let right = input.count_and_consume_key(modifiers, Key::ArrowRight) as f32;
                step * (right - input.count_and_consume_key(modifiers, Key::ArrowLeft) as f32)
            };
            step(Modifiers::SHIFT, 10.0 * STEP) + step(Modifiers::NONE, STEP)
        });
    }
    divider.clamp(0.0, 1.0)
}

/// Draws the divider at `x`.
pub(super) fn paint(painter: &Painter, canvas: Rect, x: f32) {
    let shadow = Stroke::new(3.0, Color32::from_black_alpha(120));
    painter.vline(x, canvas.y_range(), shadow);
    painter.vline(x, canvas.y_range(), Stroke::new(1.0, Color32::WHITE));
    let middle = pos2(x, canvas.center().y);
    painter.rect_filled(Rect::from_center_size(middle, vec2(9.0, 36.0)), 4.0, Color32::from_gray(235));
    for offset in [-1.5, 1.5] {
        let grip = middle.y - 8.0..=middle.y + 8.0;
        painter.vline(middle.x + offset, grip, Stroke::new(1.0, Color32::from_gray(90)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CANVAS: Rect = Rect { min: pos2(10.0, 0.0), max: pos2(210.0, 100.0) };

    #[test]
    fn both_parts_are_the_canvas() {
        for divider in [-1.0, 0.0, 0.3, 1.0, 7.0] {
            let x = place(CANVAS, divider, 1.5);
            let [a, b] = parts(CANVAS, x);
            assert_eq!(a.union(b), CANVAS);
            assert_eq!(a.right(), b.left());
            assert!((1.5 * x - (1.5 * x).round()).abs() < 1e-4);
        }
    }

    #[test]
    fn places_left_of_the_divider_belong_to_a() {
        let x = place(CANVAS, 0.5, 1.0);
        assert_eq!((side_at(109.9, x), side_at(110.0, x)), (Side::A, Side::B));
    }
}
