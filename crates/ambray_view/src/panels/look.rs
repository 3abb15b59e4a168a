//! Colours, sizes and small parts that all panels share.

use egui::{
    Align, Align2, Color32, CornerRadius, FontId, Label, Layout, Rect, Response, RichText, Sense, Stroke,
    TextStyle, Ui, UiBuilder, pos2, vec2,
};

/// What is worth a look: changed settings, the chosen tab.
pub const ACCENT: Color32 = Color32::from_rgb(232, 164, 74);
/// Side A.
pub const SIDE_A: Color32 = Color32::from_rgb(110, 168, 222);
/// Side B.
pub const SIDE_B: Color32 = Color32::from_rgb(214, 134, 180);
/// What failed.
pub const ERROR: Color32 = Color32::from_rgb(235, 96, 88);
/// What to know.
pub const WARNING: Color32 = Color32::from_rgb(226, 178, 84);
/// What was done.
pub const DONE: Color32 = Color32::from_rgb(118, 190, 128);
/// Stages of a frame, in the order of the plot.
pub const STAGES: [Color32; 6] = [
    Color32::from_rgb(92, 136, 188),
    Color32::from_rgb(222, 186, 100),
    Color32::from_rgb(126, 178, 122),
    Color32::from_rgb(188, 116, 108),
    Color32::from_rgb(150, 128, 190),
    Color32::from_rgb(128, 132, 138),
];

/// Makes the window dark and quiet: small type, tight rows, no decoration.
pub fn apply(ctx: &egui::Context) {
    ctx.set_theme(egui::Theme::Dark);
    ctx.all_styles_mut(|style| {
        for (text, size) in [
            (TextStyle::Small, 10.5),
            (TextStyle::Body, 12.5),
            (TextStyle::Button, 12.5),
            (TextStyle::Heading, 14.0),
        ] {
            style.text_styles.insert(text, FontId::proportional(size));
        }
        style.text_styles.insert(TextStyle::Monospace, FontId::monospace(11.5));
        style.drag_value_text_style = TextStyle::Monospace;
        style.spacing.item_spacing = vec2(6.0, 4.0);
        style.spacing.button_padding = vec2(6.0, 2.0);
        style.spacing.interact_size.y = 19.0;
        style.spacing.combo_height = 320.0;
        style.spacing.scroll.floating_allocated_width = 8.0;
        style.interaction.tooltip_delay = 0.4;
        let visuals = &mut style.visuals;
        visuals.panel_fill = Color32::from_gray(34);
        visuals.window_fill = Color32::from_gray(38);
        visuals.extreme_bg_color = Color32::from_gray(22);
        visuals.window_corner_radius = CornerRadius::same(4);
        visuals.menu_corner_radius = CornerRadius::same(4);
        visuals.selection.bg_fill = Color32::from_rgb(62, 92, 124);
        visuals.selection.stroke = Stroke::new(1.0, Color32::from_gray(235));
        visuals.error_fg_color = ERROR;
        visuals.warn_fg_color = WARNING;
        visuals.slider_trailing_fill = true;
        visuals.widgets.noninteractive.fg_stroke.color = Color32::from_gray(176);
        visuals.widgets.noninteractive.bg_stroke.color = Color32::from_gray(52);
        visuals.widgets.inactive.weak_bg_fill = Color32::from_gray(54);
        visuals.widgets.inactive.bg_fill = Color32::from_gray(58);
        visuals.widgets.inactive.fg_stroke.color = Color32::from_gray(204);
    });
}

/// Draws into `place` and nowhere else: what does not fit is cut off, and takes no room.
pub fn inside<R>(ui: &mut Ui, place: Rect, add: impl FnOnce(&mut Ui) -> R) -> R {
    let layout = Layout::left_to_right(Align::Center);
    let mut child = ui.new_child(UiBuilder::new().max_rect(place).layout(layout));
    child.shrink_clip_rect(place.expand(2.0)); // frames of hovered parts reach a little farther
    add(&mut child)
}

/// A dot to click; says what it does when hovered. Drawn rather than written, so that no font can lack it.
pub fn dot(ui: &mut Ui, color: Option<Color32>, label: &str) -> Response {
    let sense = if color.is_some() { Sense::click() } else { Sense::hover() };
    let (rect, response) = ui.allocate_exact_size(vec2(10.0, ui.spacing().interact_size.y), sense);
    if let Some(color) = color {
        let radius = if response.hovered() { 4.5 } else { 3.0 };
        ui.painter().circle_filled(rect.center(), radius, color);
        response.widget_info(|| egui::WidgetInfo::labeled(egui::WidgetType::Button, true, label));
    }
    response
}

/// A part of a row that is `width` wide, whatever is in it.
pub fn cell<R>(ui: &mut Ui, width: f32, add: impl FnOnce(&mut Ui) -> R) -> R {
    let shown = ui.vertical(|ui| {
        ui.set_width(width);
        add(ui)
    });
    shown.inner
}

/// Width of the names of facts.
const FACT_WIDTH: f32 = 82.0;

/// A value beside its name.
pub fn fact(ui: &mut Ui, name: &str, value: impl Into<String>) {
    ui.horizontal_top(|ui| {
        cell(ui, FACT_WIDTH, |ui| ui.add(Label::new(RichText::new(name).weak()).truncate()));
        ui.add(Label::new(RichText::new(value).monospace()).wrap());
    });
}

/// Names with numbers at the right ends of their columns, beside each other.
pub fn columns<const N: usize>(ui: &mut Ui, cells: [Option<(RichText, String)>; N]) {
    const GAP: f32 = 12.0;
    let size = vec2(ui.available_width(), ui.text_style_height(&TextStyle::Body));
    let (_, row) = ui.allocate_space(size);
    let width = (row.width() - (N - 1) as f32 * GAP) / N as f32;
    for (i, (name, value)) in cells.into_iter().enumerate().filter_map(|(i, cell)| Some((i, cell?))) {
        let left = row.left() + i as f32 * (width + GAP);
        let place = Rect::from_min_size(pos2(left, row.top()), vec2(width, row.height()));
        inside(ui, place, |ui| {
            ui.spacing_mut().item_spacing.x = 2.0;
            ui.add(Label::new(name).selectable(false));
            ui.with_layout(Layout::right_to_left(Align::Center), |ui| {
                ui.add(Label::new(RichText::new(value).monospace()).extend());
            });
        });
    }
}

/// A bar with a share of it filled and text on it.
pub fn share_bar(ui: &mut Ui, share: f32, text: &str) {
    let size = vec2(ui.available_width(), 14.0);
    let (rect, _) = ui.allocate_exact_size(size, Sense::hover());
    let visuals = ui.visuals();
    ui.painter().rect_filled(rect, 2.0, visuals.extreme_bg_color);
    let mut filled = rect;
    filled.set_width(rect.width() * share.clamp(0.0, 1.0));
    ui.painter().rect_filled(filled, 2.0, visuals.selection.bg_fill);
    let font = FontId::monospace(10.5);
    ui.painter().text(rect.center(), Align2::CENTER_CENTER, text, font, visuals.text_color());
}

/// A large number, shortened: 1.2 M.
#[must_use]
pub fn count(n: u64) -> String {
    match n {
        0..10_000 => n.to_string(),
        10_000..1_000_000 => format!("{:.1} k", n as f64 / 1e3),
        1_000_000..1_000_000_000 => format!("{:.2} M", n as f64 / 1e6),
        _ => format!("{:.2} G", n as f64 / 1e9),
    }
}

/// A number of bytes, shortened.
#[must_use]
pub fn bytes(n: u64) -> String {
    match n {
        0..1024 => format!("{n} B"),
        1024..1_048_576 => format!("{:.1} KiB", n as f64 / 1024.0),
        1_048_576..1_073_741_824 => format!("{:.1} MiB", n as f64 / 1_048_576.0),
        _ => format!("{:.2} GiB", n as f64 / 1_073_741_824.0),
    }
}
