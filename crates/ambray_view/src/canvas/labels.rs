//! Words on the picture: what differs between the sides, and how far a picture is refined.

use ambray::settings::Settings;
use egui::{Align2, Color32, FontId, Painter, Pos2, Rect};

use crate::engine::{Difference, Rendered};

/// Most settings that a label names.
const MOST: usize = 4;
/// Room around the words, points.
const PADDING: f32 = 5.0;
/// Distance of a label from the edge, points.
pub(super) const MARGIN: f32 = 10.0;

/// Names of the sides with the settings in which they differ, such as `A: thin off` and `B: thin sheet`.
pub(super) fn sides([a, b]: &[Settings; 2]) -> [String; 2] {
    let differing = differing(a, b);
    let label = |side: &str, values: &dyn Fn(&Differing) -> String| {
        let mut words: Vec<_> = differing.iter().take(MOST).map(values).collect();
        match differing.len() {
            0 => words.push("the same settings".to_owned()),
            n if n > MOST => words.push(format!("{} more", n - MOST)),
            _ => {}
        }
        format!("{side}: {}", words.join(", "))
    };
    [
        label("A", &|Differing { name, values: [a, _] }| format!("{name} {a}")),
        label("B", &|Differing { name, values: [_, b] }| format!("{name} {b}")),
    ]
}

/// A setting with its value on both sides.
struct Differing {
    name: &'static str,
    values: [String; 2],
}

fn differing(a: &Settings, b: &Settings) -> Vec<Differing> {
    let both = Settings::fields()
        .iter()
        .filter_map(|field| Some((field.name, a.get(field.name)?, b.get(field.name)?)));
    both.filter(|(_, a, b)| a != b).map(|(name, a, b)| Differing { name, values: [a, b] }).collect()
}

/// How far a picture is refined, such as `refining 1/4, 8 spp`; `None` where there is nothing to say.
pub(super) fn level(rendered: &Rendered) -> Option<String> {
    let level = &rendered.level;
    if level.is_final {
        return (rendered.frames > 1).then(|| format!("{} frames", rendered.frames));
    }
    let scale = (level.scale < 1.0).then(|| format!("1/{:.0}", 1.0 / level.scale));
    let spp = (level.spp > 0).then(|| format!("{} spp", level.spp));
    let parts: Vec<String> = scale.into_iter().chain(spp).collect();
    Some(format!("refining {}", parts.join(", ")))
}

/// The numbers of a difference.
pub(super) fn difference(difference: &Difference) -> String {
    let Difference { rmse, bias, largest, .. } = difference;
    format!("A \u{2212} B: RMSE {rmse:.5}, bias {bias:+.5}, largest {largest:.4}")
}

/// Says how far the picture is magnified, and how that ends.
pub(super) fn zoom(painter: &Painter, canvas: Rect, factor: f32) {
    let text = format!("{factor:.1} \u{d7}   0 shows all");
    paint(painter, canvas.shrink(MARGIN).center_top(), Align2::CENTER_TOP, &text);
}

/// Writes words with a dark ground; gives the place that they take.
pub(super) fn paint(painter: &Painter, at: Pos2, anchor: Align2, text: &str) -> Rect {
    let galley = painter.layout_no_wrap(text.to_owned(), FontId::proportional(12.5), Color32::from_gray(235));
    let place = anchor.anchor_size(at, galley.size() + egui::Vec2::splat(2.0 * PADDING));
    painter.rect_filled(place, 4.0, Color32::from_black_alpha(165));
    painter.galley(place.min + egui::Vec2::splat(PADDING), galley, Color32::WHITE);
    place
}

#[cfg(test)]
mod tests {
    use ambray::settings::{Preset, Thin};

    use super::*;

    #[test]
    fn labels_name_what_differs() {
        let a = Settings::default();
        let b = Settings { thin: Thin::Sheet, ..Settings::default() };
        assert_eq!(sides(&[a.clone(), b.clone()]), ["A: thin off", "B: thin sheet"]);
        let b = Settings { spp: 4, ..b };
        assert_eq!(sides(&[a.clone(), b]), ["A: spp 8, thin off", "B: spp 4, thin sheet"]);
        assert_eq!(sides(&[a.clone(), a])[1], "B: the same settings");
    }

    #[test]
    fn labels_stay_short() {
        let mut b = Settings::default();
        Preset::Reference.patch().apply(&mut b);
        let b =
            Settings { spp: 3, seed: 9, frame: 7, filter_plane: 2.0, exponent: 2.0, thin: Thin::Paper, ..b };
        let [a, _] = sides(&[Settings::default(), b]);
        assert!(a.ends_with(" more") && a.matches(',').count() == MOST, "{a}");
    }
}
