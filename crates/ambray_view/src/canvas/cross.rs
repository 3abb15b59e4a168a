//! The axes of the world in a corner of the picture; a click on an end looks along it.

use ambray::camera::Camera;
use egui::{Align2, Color32, FontId, Id, Painter, Pos2, Rect, Sense, Stroke, Ui, Vec2, vec2};
use glam::Vec3;

use crate::camera::AxisView;

/// Length of an axis, points.
const LENGTH: f32 = 26.0;
/// Radius of an end, points.
const END: f32 = 7.0;

/// The end of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
struct End {
    view: AxisView,
    /// From the middle of the cross, points.
    offset: Vec2,
    /// Towards the viewer.
    nearness: f32,
}

/// The ends from the farthest to the nearest one, as a camera with these directions sees them.
fn ends(right: Vec3, up: Vec3, forward: Vec3) -> [End; 6] {
    let mut ends = AxisView::ALL.map(|view| {
        let axis = view.from();
        let offset = LENGTH * vec2(axis.dot(right), -axis.dot(up));
        End { view, offset, nearness: -axis.dot(forward) }
    });
    ends.sort_by(|a, b| a.nearness.total_cmp(&b.nearness));
    ends
}

const fn color(view: AxisView) -> Color32 {
    match view {
        AxisView::Right | AxisView::Left => Color32::from_rgb(226, 82, 82),
        AxisView::Top | AxisView::Bottom => Color32::from_rgb(126, 196, 84),
        AxisView::Front | AxisView::Back => Color32::from_rgb(88, 146, 236),
    }
}

/// Name of the axis, if this is its positive end.
const fn letter(view: AxisView) -> Option<&'static str> {
    match view {
        AxisView::Right => Some("x"),
        AxisView::Top => Some("y"),
        AxisView::Front => Some("z"),
        _ => None,
    }
}

/// Draws the cross in the lower right corner of `canvas`; gives the view that was clicked.
pub(super) fn show(ui: &Ui, canvas: Rect, camera: &Camera) -> Option<AxisView> {
    let reach = LENGTH + END + 6.0;
    if canvas.width() < 4.0 * reach || canvas.height() < 4.0 * reach {
        return None;
    }
    let middle = canvas.right_bottom() - Vec2::splat(reach + 4.0);
    let ends = ends(camera.right(), camera.up(), camera.forward());
    let mut clicked = None;
    for end in &ends {
        let place = Rect::from_center_size(middle + end.offset, Vec2::splat(2.0 * END));
        let response = ui.interact(place, Id::new(("axis", end.view.name())), Sense::click());
        if response.on_hover_text(format!("look from the {}", end.view.name())).clicked() {
            clicked = Some(end.view);
        }
    }
    paint(ui.painter(), middle, &ends);
    clicked
}

fn paint(painter: &Painter, middle: Pos2, ends: &[End]) {
    painter.circle_filled(middle, LENGTH + END + 4.0, Color32::from_black_alpha(90));
    for end in ends {
        // What points away is dimmer.
        let color = color(end.view).gamma_multiply(0.7 + 0.3 * end.nearness);
        let tip = middle + end.offset;
        match letter(end.view) {
            Some(letter) => {
                painter.line_segment([middle, tip], Stroke::new(2.0, color));
                painter.circle_filled(tip, END, color);
                painter.text(
                    tip,
                    Align2::CENTER_CENTER,
                    letter,
                    FontId::proportional(10.0),
                    Color32::from_gray(20),
                );
            }
            None => {
                painter.circle(tip, 0.75 * END, Color32::from_black_alpha(120), Stroke::new(1.0, color));
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_point_where_the_camera_sees_them() {
        let ends = ends(Vec3::X, Vec3::Y, Vec3::NEG_Z);
        let end = |view| ends.iter().find(|end| end.view == view).expect("all are there");
        assert_eq!(end(AxisView::Right).offset, vec2(LENGTH, 0.0));
        assert_eq!(end(AxisView::Top).offset, vec2(0.0, -LENGTH));
        assert_eq!(ends[5].view, AxisView::Front, "+z comes towards the viewer");
        assert_eq!(ends[0].view, AxisView::Back);
    }
}
