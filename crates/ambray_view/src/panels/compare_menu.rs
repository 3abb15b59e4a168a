//! The comparison of two settings, and pairs that are often compared.

use ambray::settings::{Method, Preset, Settings, Thin, Window};
use egui::{Button, Ui};

use super::Desk;
use crate::model::{Comparison, Model, Side};

/// Two looks worth comparing: their name, what is seen, and what makes A and B of the settings of A.
pub(crate) struct Pair {
    pub(crate) name: &'static str,
    meaning: &'static str,
    make: fn(&mut Settings, &mut Settings),
}

/// All pairs.
pub(crate) const PAIRS: [Pair; 4] = [
    Pair {
        name: "thin off | sheet",
        meaning: "What the second batch of rays finds at the hem of a curtain",
        make: |a, b| (a.thin, b.thin) = (Thin::Off, Thin::Sheet),
    },
    Pair {
        name: "4 | 8 rays per pixel",
        meaning: "Whether more rays are worth it",
        make: |a, b| (a.spp, b.spp) = (4, 8),
    },
    Pair {
        name: "filtered | raw",
        meaning: "What the geometry-aware filter does",
        make: |a, b| {
            if a.filter == Window::Off {
                a.filter = Window::Centred;
            }
            b.filter = Window::Off;
        },
    },
    Pair {
        name: "this | converged reference",
        meaning: "The picture beside 1024 rays per pixel, unfiltered",
        make: |_, b| {
            Preset::Reference.patch().apply(b);
            // No number of rays lets the depth buffer converge.
            if b.method.is_screen_space() {
                b.method = Method::Ambray;
            }
        },
    },
];

impl Pair {
    /// The pair, made from side A.
    fn made(&self, model: &Model) -> [Settings; 2] {
        let mut a = model.of(Side::A).clone();
        let mut b = a.clone();
        (self.make)(&mut a, &mut b);
        [a, b]
    }

    /// Why the pair cannot be rendered where side A can be.
    fn refusal(&self, model: &Model) -> Option<String> {
        let known = model.of(Side::A).validate();
        let mut problems = self.made(model).into_iter().flat_map(|settings| settings.validate());
        problems.find(|problem| !known.contains(problem)).map(|problem| problem.to_string())
    }

    /// Shows the pair.
    pub(crate) fn apply(&self, model: &mut Model) {
        model.settings = self.made(model);
        if model.comparison == Comparison::Off {
            model.compare(Comparison::Split);
        }
    }
}

pub(super) fn show(ui: &mut Ui, desk: &mut Desk<'_>) {
    for (comparison, name) in [
        (Comparison::Off, "Off"),
        (Comparison::Split, "Split with a divider"),
        (Comparison::Difference, "Difference"),
    ] {
        if ui.radio(desk.model.comparison == comparison, name).clicked() {
            desk.model.compare(comparison);
        }
    }
    ui.separator();
    for pair in &PAIRS {
        let refusal = pair.refusal(desk.model);
        let button = ui.add_enabled(refusal.is_none(), Button::new(pair.name)).on_hover_text(pair.meaning);
        if button.on_disabled_hover_text(refusal.unwrap_or_default()).clicked() {
            pair.apply(desk.model);
        }
    }
    ui.separator();
    if ui.button("Swap A and B").clicked() {
        desk.model.settings.swap(0, 1);
    }
    if ui.button("Copy A to B").clicked() {
        let a = desk.model.of(Side::A).clone();
        *desk.model.of_mut(Side::B) = a;
    }
    if ui.button("Copy B to A").clicked() {
        let b = desk.model.of(Side::B).clone();
        *desk.model.of_mut(Side::A) = b;
    }
}
