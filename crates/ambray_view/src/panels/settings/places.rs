//! Where the parts of a row lie. A row is as wide as its panel, whatever it holds: no editor can push the panel wider.

use ambray::settings::Kind;
use egui::{Rect, pos2, vec2};

/// Width of a dot, and of the room behind it.
const DOT: f32 = 12.0;
/// Room between the parts of a row.
const GAP: f32 = 6.0;
/// Room between numbers that stand beside each other.
pub(super) const PART_GAP: f32 = 3.0;
/// Width of the patch of a colour.
pub(super) const PATCH: f32 = 26.0;

/// The parts of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Places {
    pub(super) dot: Rect,
    pub(super) name: Rect,
    pub(super) editor: Rect,
    pub(super) auto: Option<Rect>,
    /// Everything.
    pub(super) row: Rect,
}

/// Whether there is room to write `auto` behind its box in a row of this width.
pub(super) fn says_auto(width: f32) -> bool {
    width >= 290.0
}

/// The narrowest editor of numbers beside each other in which they can be read.
fn least(kind: Kind) -> f32 {
    match kind {
        Kind::Rgb | Kind::AutoRgb => PATCH + 3.0 * (31.0 + PART_GAP),
        Kind::AutoTriple => 3.0 * 64.0 + 2.0 * PART_GAP,
        Kind::AutoRange | Kind::Size => 2.0 * 52.0 + PART_GAP,
        _ => 0.0,
    }
}

impl Places {
    /// The parts of a row of `width` whose lines are `height` high; where one line is too narrow, the editor takes a second.
    pub(super) fn of(width: f32, height: f32, kind: Kind) -> Self {
        let auto_width = match (kind.has_auto(), says_auto(width)) {
            (false, _) => 0.0,
            (true, true) => 45.0,
            (true, false) => 19.0,
        };
        let name_width = (0.35 * width).clamp(80.0, 140.0);
        let line = |left: f32, right: f32, top: f32| {
            Rect::from_min_max(pos2(left, top), pos2(right.max(left), top + height))
        };
        let right = width - if kind.has_auto() { auto_width + GAP } else { 0.0 };
        let beside = line(DOT + name_width + GAP, right, 0.0);
        let is_tall = beside.width() < least(kind);
        let editor = if is_tall { line(DOT, width, height + 1.0) } else { beside };
        let lines = if is_tall { 2.0 * height + 1.0 } else { height };
        Self {
            dot: line(0.0, DOT - 2.0, 0.0),
            name: line(DOT, if is_tall { right } else { DOT + name_width }, 0.0),
            editor,
            auto: kind.has_auto().then(|| line(width - auto_width, width, 0.0)),
            row: Rect::from_min_size(pos2(0.0, 0.0), vec2(width, lines)),
        }
    }

    /// The same, from `corner` on.
    pub(super) fn at(self, corner: egui::Pos2) -> Self {
        let to = corner.to_vec2();
        Self {
            dot: self.dot.translate(to),
            name: self.name.translate(to),
            editor: self.editor.translate(to),
            auto: self.auto.map(|auto| auto.translate(to)),
            row: self.row.translate(to),
        }
    }
}

/// So many places of equal width beside each other in `room`.
pub(super) fn beside(room: Rect, count: usize) -> impl Iterator<Item = Rect> {
    let width = (room.width() - (count - 1) as f32 * PART_GAP) / count as f32;
    (0..count).map(move |i| {
        let left = room.left() + i as f32 * (width + PART_GAP);
        Rect::from_min_size(pos2(left, room.top()), vec2(width, room.height()))
    })
}

#[cfg(test)]
mod tests {
    use ambray::settings::Settings;

    use super::*;

    #[test]
    fn the_parts_of_a_row_lie_in_it_beside_each_other_at_every_width() {
        for field in Settings::fields() {
            for width in [236.0, 244.0, 306.0, 314.0, 544.0] {
                let places = Places::of(width, 19.0, field.kind);
                assert_eq!(places.row.width(), width);
                let parts = [Some(places.dot), Some(places.name), Some(places.editor), places.auto];
                let parts: Vec<_> = parts.into_iter().flatten().collect();
                for (i, part) in parts.iter().enumerate() {
                    assert!(places.row.contains_rect(*part), "{} at {width}: {part:?}", field.name);
                    let others = parts.iter().skip(i + 1);
                    assert!(
                        others.clone().all(|other| !part.shrink(0.1).intersects(*other)),
                        "{}",
                        field.name
                    );
                }
                let least = least(field.kind).max(if width > 300.0 { 100.0 } else { 90.0 });
                assert!(places.editor.width() >= least, "{} at {width}: {places:?}", field.name);
            }
        }
    }
}
