//! A document as one HTML file: works offline and without a server, and asks for nothing outside itself.

mod compare;
mod ids;
mod number;
mod plot;
mod shell;
mod store;
mod table;

use maud::{Markup, html};

use crate::document::{Block, Document};
use ids::{Unique, slug};
use store::Store;

pub use store::pictures;

/// The page of `document`. Pictures are embedded, each once; style and script are in the page; its content security
/// policy forbids every request.
#[must_use]
pub fn page(document: &Document) -> String {
    let store = Store::new(document);
    let mut ids = Unique::default();
    let sections: Vec<(String, &str)> = document
        .sections
        .iter()
        .map(|section| {
            // Numbered, so that no heading can take the name of a picture.
            let name = format!("section-{}", slug(&section.title, "untitled"));
            (ids.name(&name), section.title.as_str())
        })
        .collect();
    let body = html! {
        @for (section, (id, title)) in document.sections.iter().zip(&sections) {
            section id=(id) {
                h2 { (title) a.anchor href={ "#" (id) } aria-label={ "Link to " (title) } { "#" } }
                @for (i, content) in section.blocks.iter().enumerate() {
                    (block(&store, &ids.name(&format!("{id}-block-{}", i + 1)), content))
                }
            }
        }
    };
    shell::page(document, &sections, &body, &store.embedded())
}

fn block(store: &Store<'_>, id: &str, block: &Block) -> Markup {
    match block {
        Block::Text(text) => html! { p { (text) } },
        Block::Finding { claim, measured, holds } => finding(claim, measured, *holds),
        Block::Slider { caption, pictures, left, right } => {
            compare::slider(store, id, caption, pictures, *left, *right)
        }
        Block::Gallery { caption, pictures, columns } => {
            compare::gallery(store, id, caption, pictures, *columns)
        }
        Block::Table(table) => table::table(table, id),
        Block::Plot(plot) => plot::plot(plot, id),
        Block::Command(text) => html! {
            div.block.command id=(id) {
                pre tabindex="0" { code { (text) } }
                button.copy type="button" { "Copy" }
            }
        },
    }
}

fn finding(claim: &str, measured: &str, holds: bool) -> Markup {
    html! {
        div.block.finding.holds[holds].fails[!holds] {
            p.verdict { @if holds { "✓ holds" } @else { "✗ does not hold" } }
            dl {
                dt { "Claim" } dd { (claim) }
                dt { "Measured" } dd { (measured) }
            }
        }
    }
}

#[cfg(test)]
mod tests;
