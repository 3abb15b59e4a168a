//! Pictures to compare: two over each other with a divider, or several side by side.

use maud::{Markup, html};

use super::store::Store;
use crate::document::Picture;

/// Help of the slider for who has a mouse, shown until it is over it.
const SLIDER_HELP: &str = "Drag the divider, or move it with the arrow keys. Wheel or + and − zoom at the pointer, drag pans, \
    double click or 0 resets. Keys 1–9 choose the picture on the pointer's side, X swaps.";

/// Help for who has fingers only.
const TOUCH_HELP: &str = "Two fingers zoom and pan, a double tap resets; a touch reads the pixel under it.";

/// Help of the gallery.
const GALLERY_HELP: &str =
    "Wheel or + and − zoom all pictures at the pointer, drag pans, double click or 0 resets.";

/// Two of `pictures` over each other.
pub(super) fn slider(
    store: &Store<'_>,
    id: &str,
    caption: &str,
    pictures: &[Picture],
    left: usize,
    right: usize,
) -> Markup {
    let Some(last) = pictures.len().checked_sub(1) else { return html! {} };
    let (left, right) = (left.min(last), right.min(last));
    let text = |side: &str, picture: &Picture| {
        html! {
            p class={ "caption " (side) } {
                b { (picture.name) } span { @if !picture.caption.is_empty() { " – " (picture.caption) } }
            }
        }
    };
    html! {
        figure.block.slider.zooms.tall[is_tall(&pictures[left])] id=(id) {
            figcaption { (caption) }
            div.tools {
                (choice(store, "Left", pictures, left))
                (choice(store, "Right", pictures, right))
                (zoom_buttons())
            }
            div.stage {
                (store.shown(&pictures[left], "left"))
                (store.shown(&pictures[right], "right"))
                span.tag.left { (pictures[left].name) }
                span.tag.right { (pictures[right].name) }
                div.divider role="slider" tabindex="0" aria-orientation="horizontal" aria-label={ "Divider: " (caption) }
                    aria-valuemin="0" aria-valuemax="100" aria-valuenow="50" aria-valuetext="50 %" {}
            }
            (readout(SLIDER_HELP))
            (text("left", &pictures[left]))
            (text("right", &pictures[right]))
        }
    }
}

/// Whether a picture as wide as the page would not fit into a window.
fn is_tall(picture: &Picture) -> bool {
    picture.height > picture.width * 2 / 3
}

/// The menu of one side.
fn choice(store: &Store<'_>, side: &str, pictures: &[Picture], chosen: usize) -> Markup {
    html! {
        label.choice { (side) " "
            select data-side=(side.to_lowercase()) autocomplete="off" {
                @for (i, picture) in pictures.iter().enumerate() {
                    option value=(store.id(picture)) selected[i == chosen] data-name=(picture.name)
                        data-caption=(picture.caption) {
                        @if i < 9 { (i + 1) " · " } (picture.name)
                    }
                }
            }
        }
    }
}

/// `pictures` side by side.
pub(super) fn gallery(
    store: &Store<'_>,
    id: &str,
    caption: &str,
    pictures: &[Picture],
    columns: usize,
) -> Markup {
    html! {
        figure.block.gallery.zooms id=(id) {
            figcaption { (caption) }
            div.tools { (zoom_buttons()) }
            div class={ "grid columns-" (columns.clamp(1, MOST_COLUMNS)) } {
                @for picture in pictures {
                    div.item {
                        div.stage { (store.shown(picture, "only")) }
                        p.caption { b { (picture.name) } @if !picture.caption.is_empty() { " – " (picture.caption) } }
                    }
                }
            }
            (readout(GALLERY_HELP))
        }
    }
}

/// Columns that the style sheet knows.
const MOST_COLUMNS: usize = 6;

fn zoom_buttons() -> Markup {
    html! {
        span.zoom role="group" aria-label="Zoom" {
            button type="button" data-zoom="out" aria-label="Zoom out" { "−" }
            output { "1×" }
            button type="button" data-zoom="in" aria-label="Zoom in" { "+" }
            button type="button" data-zoom="reset" { "Reset" }
        }
    }
}

fn readout(help: &str) -> Markup {
    html! { p.readout { span.by-mouse { (help) } span.by-touch { (TOUCH_HELP) } } }
}
