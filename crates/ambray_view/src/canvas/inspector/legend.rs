//! What the inspector draws, in which colours, and what of it is wanted.

use egui::{Color32, Sense, Ui, vec2};

/// A kind of line or mark.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    Hit,
    Miss,
    Chord,
    Blocked,
    Light,
    Shadow,
    Accepted,
    Refused,
}

impl Kind {
    pub(super) const fn color(self) -> Color32 {
        match self {
            Self::Hit => Color32::from_rgb(255, 150, 50),
            Self::Miss => Color32::from_rgb(120, 190, 255),
            Self::Chord => Color32::from_rgb(180, 230, 120),
            Self::Blocked => Color32::from_rgb(255, 70, 110),
            Self::Light => Color32::from_rgb(255, 236, 140),
            Self::Shadow => Color32::from_rgb(150, 110, 220),
            Self::Accepted => Color32::from_rgb(90, 220, 120),
            Self::Refused => Color32::from_rgb(240, 80, 80),
        }
    }

    const fn words(self) -> &'static str {
        match self {
            Self::Hit => "hit",
            Self::Miss => "miss, to its end or the radius",
            Self::Chord => "free chord",
            Self::Blocked => "blocked chord",
            Self::Light => "ray to a light",
            Self::Shadow => "ray to a light, blocked",
            Self::Accepted => "accepted by the filter",
            Self::Refused => "refused by the filter",
        }
    }
}

/// Which kinds are drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(clippy::struct_excessive_bools, reason = "each is a box to tick")]
pub(super) struct Wanted {
    pub(super) hits: bool,
    pub(super) misses: bool,
    pub(super) chords: bool,
    pub(super) shadows: bool,
    pub(super) taps: bool,
}

impl Default for Wanted {
    fn default() -> Self {
        Self { hits: true, misses: true, chords: true, shadows: false, taps: true }
    }
}

impl Wanted {
    /// The legend, with a box to tick for each group.
    pub(super) fn edit(&mut self, ui: &mut Ui) {
        use Kind::{Accepted, Blocked, Chord, Hit, Light, Miss, Refused, Shadow};
        let groups: [(&mut bool, &str, &[Kind]); 5] = [
            (&mut self.hits, "Hits", &[Hit]),
            (&mut self.misses, "Misses", &[Miss]),
            (&mut self.chords, "Chords", &[Chord, Blocked]),
            (&mut self.shadows, "Shadow rays", &[Light, Shadow]),
            (&mut self.taps, "Filter taps", &[Accepted, Refused]),
        ];
        ui.horizontal_wrapped(|ui| {
            for (wanted, name, kinds) in groups {
                ui.checkbox(wanted, name);
                for kind in kinds {
                    let (place, response) = ui.allocate_exact_size(vec2(12.0, 12.0), Sense::hover());
                    ui.painter().rect_filled(place, 2.0, kind.color());
                    response.on_hover_text(kind.words());
                }
                ui.add_space(6.0);
            }
        });
        ui.weak("Parts behind a visible surface are fainter.");
    }
}
