//! The report of `ambray compare` in a real browser: it is dragged, zoomed, sorted and looked at as a reader would.
#![forbid(unsafe_code)]

mod gestures;
mod heard;
mod sample;

use std::path::PathBuf;

use ambray_compare::html::page;
use conformance::browser::{Browser, Look, report};

/// Where pictures of the page are kept to be looked at.
fn kept(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{name}"))
}

#[test]
fn everything_works_on_a_desk_and_on_a_phone_by_day_and_by_night() {
    let Some(mut browser) = Browser::start() else { return };
    let html = page(&sample::document());
    let looks = [
        ("desktop", Look::DESKTOP),
        ("desktop-dark", Look::DESKTOP.dark()),
        ("wide", Look { width: 1700, ..Look::DESKTOP }),
        ("phone", Look::PHONE),
        ("phone-dark", Look::PHONE.dark()),
    ];
    for (name, look) in looks {
        println!("{name}");
        let mut page = browser.open_text(&html, look);
        page.screenshot_all(&kept(&format!("{name}.png")));
        report::check(&mut page);
    }
}

#[test]
fn the_page_can_be_printed() {
    let Some(mut browser) = Browser::start() else { return };
    let mut page = browser.open_text(&page(&sample::document()), Look::DESKTOP);
    page.print(&kept("print.pdf"));
    report::assert_clean(&mut page);
}

#[test]
fn the_page_is_dark_when_asked_to_be() {
    let Some(mut browser) = Browser::start() else { return };
    let html = page(&sample::document());
    let mut paper = |look| {
        let colour = browser.open_text(&html, look).text("getComputedStyle(document.body).backgroundColor");
        let channels = colour.trim_start_matches("rgb(").trim_end_matches(')').split(", ");
        channels.map(|channel| channel.parse::<u32>().expect("a channel")).max().expect("three channels")
    };
    assert_eq!(paper(Look::DESKTOP), 255);
    assert!(paper(Look::DESKTOP.dark()) < 64);
}
