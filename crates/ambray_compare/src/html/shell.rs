//! What stands around the blocks of a page: its head, with the policy that nothing outside is asked for, its front and
//! its table of contents.

use base64::{Engine as _, engine::general_purpose::STANDARD};
use maud::{DOCTYPE, Markup, PreEscaped, html};
use sha2::{Digest as _, Sha256};

use crate::document::{Block, Document};

/// How the page looks.
const STYLE: &str = concat!(
    include_str!("../../assets/report.css"),
    include_str!("../../assets/pictures.css"),
    include_str!("../../assets/print.css")
);

/// What the page does; one scope of its own.
const SCRIPT: &str = concat!(
    "(() => {\n\"use strict\";\n",
    include_str!("../../assets/view.js"),
    include_str!("../../assets/pixels.js"),
    include_str!("../../assets/gestures.js"),
    include_str!("../../assets/slider.js"),
    include_str!("../../assets/gallery.js"),
    include_str!("../../assets/table.js"),
    include_str!("../../assets/plot.js"),
    include_str!("../../assets/report.js"),
    "})();\n"
);

/// A whole page: `sections` are pairs of id and heading, `body` is what stands in them, `store` the pictures.
pub(super) fn page(
    document: &Document,
    sections: &[(String, &str)],
    body: &Markup,
    store: &Markup,
) -> String {
    let markup = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                // Before anything that it governs.
                meta http-equiv="Content-Security-Policy" content=(policy());
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                meta name="generator" content="ambray compare";
                title { (document.title) }
                // Without one, browsers ask for /favicon.ico.
                link rel="icon" href="data:,";
                style { (PreEscaped(STYLE)) }
            }
            body {
                (contents(sections))
                main {
                    (front(document))
                    (body)
                }
                (store)
                script { (PreEscaped(SCRIPT)) }
            }
        }
    };
    markup.into_string()
}

/// Everything is forbidden but embedded pictures and the page's own style and script, which are known by their digests.
fn policy() -> String {
    let digest = |text: &str| STANDARD.encode(Sha256::digest(text));
    format!(
        "default-src 'none'; img-src data:; style-src 'sha256-{}'; script-src 'sha256-{}'; \
         base-uri 'none'; form-action 'none'",
        digest(STYLE),
        digest(SCRIPT)
    )
}

fn contents(sections: &[(String, &str)]) -> Markup {
    html! {
        @if sections.len() > 1 {
            nav.contents aria-label="Contents" {
                p { "Contents" }
                ol {
                    @for (id, title) in sections { li { a href={ "#" (id) } { (title) } } }
                }
            }
        }
    }
}

/// Title, summary, how many claims hold, and what made the report.
fn front(document: &Document) -> Markup {
    let verdicts: Vec<bool> = document
        .blocks()
        .filter_map(|block| if let Block::Finding { holds, .. } = block { Some(*holds) } else { None })
        .collect();
    html! {
        header {
            h1 { (document.title) }
            @if !document.summary.is_empty() { p.summary { (document.summary) } }
            @if !verdicts.is_empty() {
                p.verdicts {
                    (verdicts.iter().filter(|&&holds| holds).count()) " of " (verdicts.len())
                    @if verdicts.len() == 1 { " claim holds." } @else { " claims hold." }
                }
            }
            @if !document.facts.is_empty() {
                dl.facts {
                    @for (name, value) in &document.facts { div { dt { (name) } dd { (value) } } }
                }
            }
        }
    }
}
