//! The pictures of a page: each is embedded once, wherever and however often it is seen.

use std::collections::HashMap;

use base64::{Engine as _, engine::general_purpose::STANDARD};
use maud::{Markup, html};

use super::ids::{Unique, slug};
use crate::document::{Document, Picture};

/// The different pictures of a document.
#[derive(Debug)]
pub(super) struct Store<'a> {
    pictures: Vec<&'a Picture>,
    index: HashMap<&'a [u8], usize>,
}

impl<'a> Store<'a> {
    /// Those of `document`; what has the same bytes is the same picture.
    pub(super) fn new(document: &'a Document) -> Self {
        let mut store = Self { pictures: Vec::new(), index: HashMap::new() };
        for picture in document.pictures() {
            store.index.entry(&picture.png).or_insert_with(|| {
                store.pictures.push(picture);
                store.pictures.len() - 1
            });
        }
        store
    }

    /// The id under which `picture` is embedded.
    pub(super) fn id(&self, picture: &Picture) -> String {
        format!("picture-{}", self.index[&*picture.png])
    }

    /// All of them, shown nowhere by themselves: [`Self::shown`] refers to them.
    pub(super) fn embedded(&self) -> Markup {
        html! {
            svg.store aria-hidden="true" width="0" height="0" {
                defs {
                    @for picture in &self.pictures {
                        image id=(self.id(picture)) width=(picture.width) height=(picture.height)
                            preserveAspectRatio="none"
                            href={ "data:image/png;base64," (STANDARD.encode(&picture.png)) };
                    }
                }
            }
        }
    }

    /// `picture` where it is seen, as an element of `class`. An SVG that refers to the embedded picture needs no script,
    /// can be printed, and is enlarged by its view box.
    pub(super) fn shown(&self, picture: &Picture, class: &str) -> Markup {
        html! {
            svg class={ "picture " (class) } role="img" aria-label=(picture.name) preserveAspectRatio="none"
                width=(picture.width) height=(picture.height) viewBox={ "0 0 " (picture.width) " " (picture.height) } {
                use href={ "#" (self.id(picture)) };
            }
        }
    }
}

/// The pictures of `document` as files: a safe name that ends in `.png`, and the bytes. A picture that is seen several
/// times under one name comes once; different pictures never share a name.
pub fn pictures(document: &Document) -> impl Iterator<Item = (String, &[u8])> {
    let mut names = Unique::default();
    let mut seen = HashMap::<String, Vec<&[u8]>>::new();
    document.pictures().filter_map(move |picture| {
        let name = slug(&picture.name, "picture");
        let alike = seen.entry(name.clone()).or_default();
        if alike.contains(&&*picture.png) {
            return None;
        }
        alike.push(&picture.png);
        Some((format!("{}.png", names.name(&name)), &*picture.png))
    })
}
