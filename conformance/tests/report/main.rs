//! The report of `ambray compare` in a real browser: it is dragged, zoomed, sorted and looked at as a reader would.
#![forbid(unsafe_code)]

mod data;
mod gestures;
mod heard;
mod measured;
mod sample;

use std::path::PathBuf;

use ambray_compare::html::page;
use conformance::browser::{Browser, Look, Page, report};

/// Where pictures of the page are kept to be looked at.
fn kept(name: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_TARGET_TMPDIR")).join(format!("report-{name}"))
}

/// The sample in a browser of its own.
fn open(look: Look) -> Option<(Browser, Page)> {
    let mut browser = Browser::start()?;
    let page = browser.open_text(&page(&sample::document()), look);
    Some((browser, page))
}

#[test]
fn everything_works_on_a_desk_and_on_a_phone_by_day_and_by_night() {
    let Some(mut browser) = Browser::start() else { return };
    let html = page(&sample::document());
    std::fs::write(kept("page.html"), &html).expect("a file");
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

#[test]
fn without_script_the_page_still_shows_its_pictures_and_plots() {
    let Some(mut browser) = Browser::start() else { return };
    let html = page(&sample::document());
    let (before, script) = html.split_once("<script>").expect("a script");
    let (_, after) = script.split_once("</script>").expect("its end");
    let mut page = browser.open_text(&format!("{before}{after}"), Look::DESKTOP);
    page.screenshot_all(&kept("without-script.png"));
    let clip = page.text("getComputedStyle(document.querySelector('.slider .picture.right')).clipPath");
    assert_eq!(clip, "inset(0px 0px 0px 50%)");
    let idle = "[...document.querySelectorAll('.tools, .divider, .readout, .copy')]";
    let seen = format!("{idle}.filter(element => element.checkVisibility()).length");
    assert_eq!(page.number(&seen), 0.0, "what does nothing is not shown");
    assert!(page.number("document.querySelector('.chart').getBoundingClientRect().width") > 300.0);
    assert!(page.text("document.querySelector('.point title').textContent").starts_with("Ambray – 1 rays"));
    report::assert_clean(&mut page);
}
