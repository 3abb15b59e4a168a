use std::{collections::HashSet, sync::Arc};

use super::*;
use crate::document::{Picture, Plot, Section, Series, Table};

/// A picture of which only its bytes matter.
fn picture(name: &str, bytes: &[u8]) -> Picture {
    Picture { name: name.into(), caption: "<em>".into(), width: 4, height: 2, png: Arc::from(bytes) }
}

fn sample() -> Document {
    let (a, b) = (picture("a & b", b"first"), picture("b", b"second"));
    let again = picture("also a", b"first");
    let slider = Block::Slider { caption: "<b>".into(), pictures: vec![a.clone(), b], left: 0, right: 9 };
    let gallery = Block::Gallery { caption: "g".into(), pictures: vec![again, a], columns: 0 };
    let series = Series { name: "s".into(), points: vec![(1.0, 2.0)], labels: Vec::new() };
    let plot = Plot { series: vec![series], ..Plot::default() };
    let blocks = vec![Block::Text("</script><img src=x>".into()), slider, gallery, Block::Plot(plot)];
    let empty = Block::Slider { caption: "none".into(), pictures: Vec::new(), left: 0, right: 0 };
    let blocks_again = vec![Block::Table(Table::default()), Block::Command("a && b".into()), empty];
    Document {
        title: "<title>".into(),
        summary: "\"quoted\"".into(),
        facts: vec![("<name>".into(), "<value>".into())],
        sections: vec![
            Section { title: "Picture 0".into(), blocks },
            Section { title: "picture-0".into(), blocks: blocks_again },
        ],
    }
}

/// What follows `before` up to a quote, wherever it stands in `text`.
fn values<'a>(text: &'a str, before: &str) -> Vec<&'a str> {
    text.split(before).skip(1).map(|rest| rest.split('"').next().expect("a quote")).collect()
}

#[test]
fn what_a_document_says_is_text_and_not_markup() {
    let page = page(&sample());
    assert!(page.contains("<title>&lt;title&gt;</title>"));
    assert_eq!(page.matches("<script>").count(), 1);
    assert!(page.contains("&lt;/script&gt;&lt;img src=x&gt;"));
    for markup in ["<em>", "<name>", "<value>", "<img"] {
        assert!(!page.contains(markup), "{markup}");
    }
}

#[test]
fn each_picture_is_embedded_once() {
    let page = page(&sample());
    // Base64 of "first" and "second".
    for data in ["data:image/png;base64,Zmlyc3Q=", "data:image/png;base64,c2Vjb25k"] {
        assert_eq!(page.matches(data).count(), 1, "{data}");
    }
    assert_eq!(page.matches("<use ").count(), 4);
}

#[test]
fn ids_are_given_once_and_all_that_is_referred_to_is_there() {
    let page = page(&sample());
    let ids = values(&page, " id=\"");
    let unique: HashSet<&str> = ids.iter().copied().collect();
    assert_eq!(unique.len(), ids.len(), "{ids:?}");
    let references = values(&page, "href=\"#");
    assert!(references.len() >= 6, "{references:?}");
    assert!(references.iter().all(|id| unique.contains(id)), "{references:?} in {ids:?}");
}

#[test]
fn the_page_names_no_other_place() {
    let page = page(&sample());
    for scheme in ["http:", "https:", "//cdn", "@import", "fetch(", "XMLHttpRequest"] {
        assert!(!page.contains(scheme), "{scheme}");
    }
    // Styles of single elements would be refused by the policy.
    assert!(!page.contains(" style=\""));
}

#[test]
fn the_policy_allows_nothing_but_what_is_in_the_page() {
    let page = page(&sample());
    let policy = values(&page, "Content-Security-Policy\" content=\"")[0];
    assert!(
        policy.starts_with("default-src &#39;none&#39;") || policy.starts_with("default-src 'none'"),
        "{policy}"
    );
    assert!(!policy.contains("unsafe") && !policy.contains('*'), "{policy}");
    assert!(page.find("Content-Security-Policy") < page.find("<style>"));
}

#[test]
fn pictures_as_files_have_safe_names_of_their_own() {
    let document = sample();
    let files: Vec<(String, &[u8])> = pictures(&document).collect();
    let expected: [(&str, &[u8]); 3] =
        [("a-b.png", b"first"), ("b.png", b"second"), ("also-a.png", b"first")];
    assert_eq!(files, expected.map(|(name, bytes)| (name.to_owned(), bytes)));
    let alike = vec![picture("../x", b"1"), picture("x", b"2"), picture("X", b"2")];
    let gallery = Block::Gallery { caption: String::new(), pictures: alike, columns: 2 };
    let sections = vec![Section { title: String::new(), blocks: vec![gallery] }];
    let document = Document { sections, ..Document::default() };
    let names: Vec<String> = pictures(&document).map(|file| file.0).collect();
    assert_eq!(names, ["x.png", "x-2.png"]);
}

#[test]
fn an_empty_document_is_a_page() {
    let page = page(&Document::default());
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>"));
}
