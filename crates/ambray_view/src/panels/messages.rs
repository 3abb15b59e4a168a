//! What is going on and what has happened: a strip and cards at the bottom of the picture, which never stop the work.

use egui::{Align2, Area, Color32, Context, Frame, Id, Order, Rect, RichText, Stroke, Ui, vec2};

use super::{Desk, action::Action, look};
use crate::app::{Notice, Severity};

/// Cards that are shown at once; older ones wait.
const MOST: usize = 4;

/// Draws over the picture in `canvas`, above the words in its lower left corner.
pub(super) fn show(ctx: &Context, desk: &mut Desk<'_>, canvas: Rect) {
    let now = ctx.input(|input| input.time);
    desk.shown.notices.retain_mut(|notice| {
        let since = *notice.since.get_or_insert(now);
        lifetime(notice.severity).is_none_or(|seconds| now - since < seconds)
    });
    let lives = desk.shown.notices.iter().filter_map(|notice| lifetime(notice.severity)).reduce(f64::min);
    if lives.is_some() {
        ctx.request_repaint_after_secs(0.25);
    }
    let corner = canvas.left_bottom() + vec2(10.0, -40.0);
    // Beside the axes in the other corner.
    let width = (canvas.width() - 110.0).clamp(120.0, 480.0);
    let area = Area::new(Id::new("messages")).order(Order::Middle).constrain(false);
    area.pivot(Align2::LEFT_BOTTOM).fixed_pos(corner).show(ctx, |ui| {
        ui.set_max_width(width);
        cards(ui, desk);
        progress(ui, desk);
    });
}

/// Seconds that a message stays; errors stay until they are dismissed.
const fn lifetime(severity: Severity) -> Option<f64> {
    match severity {
        Severity::Done => Some(4.0),
        Severity::Warning => Some(10.0),
        Severity::Error => None,
    }
}

fn frame(ui: &Ui, color: Color32) -> Frame {
    Frame::window(ui.style())
        .fill(Color32::from_rgb(30, 31, 33))
        .stroke(Stroke::new(1.0, color))
        .inner_margin(6)
}

fn progress(ui: &mut Ui, desk: &mut Desk<'_>) {
    if let Some(loading) = &desk.shown.loading {
        frame(ui, look::SIDE_A).show(ui, |ui| {
            let path = &loading.scene.path;
            let name = path.file_name().unwrap_or(path.as_os_str()).to_string_lossy();
            ui.horizontal(|ui| {
                ui.spinner();
                ui.label(format!("{name}: {}", loading.stage));
            });
            if let Some(share) = loading.share {
                look::share_bar(ui, share, &format!("{:.0} %", 100.0 * share));
            }
        });
    }
    if let Some(share) = desk.shown.export {
        frame(ui, look::SIDE_A).show(ui, |ui| {
            ui.horizontal(|ui| {
                ui.label(format!("writing, {:.0} %", 100.0 * share));
                if ui.button("Stop").clicked() {
                    desk.actions.push(Action::CancelExport);
                }
            });
            look::share_bar(ui, share, "");
        });
    }
}

fn cards(ui: &mut Ui, desk: &mut Desk<'_>) {
    let mut dismissed = None;
    // Errors first: they wait for an answer.
    let notices = &desk.shown.notices;
    let is_error = |notice: &Notice| notice.severity == Severity::Error;
    let order = (0..notices.len()).filter(|&i| is_error(&notices[i])).rev();
    let order = order.chain((0..notices.len()).filter(|&i| !is_error(&notices[i])).rev());
    for i in order.take(MOST) {
        let notice = &notices[i];
        let color = match notice.severity {
            Severity::Done => look::DONE,
            Severity::Warning => look::WARNING,
            Severity::Error => look::ERROR,
        };
        frame(ui, color).show(ui, |ui| {
            ui.horizontal(|ui| {
                look::dot(ui, Some(color), "");
                ui.scope(|ui| {
                    ui.set_max_width(ui.available_width() - 26.0); // beside the button
                    ui.add(
                        egui::Label::new(RichText::new(&notice.text).color(Color32::from_gray(222))).wrap(),
                    );
                });
                if ui.small_button("x").on_hover_text("Dismiss").clicked() {
                    dismissed = Some(i);
                }
            });
        });
    }
    if notices.len() > MOST {
        ui.weak(format!("and {} more", notices.len() - MOST));
    }
    if let Some(i) = dismissed {
        desk.shown.notices.remove(i);
    }
}
