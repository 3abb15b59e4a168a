//! The report of what was really measured, of the built-in scene.

use ambray::{
    Control, Renderer,
    scene::atrium::atrium,
    settings::{Method, Settings, Size},
};
use ambray_compare::{
    experiment::{self, Options, Work},
    html,
    report::document,
    truth::{Content, TruthOptions},
};
use conformance::browser::{Browser, Look, report};

use crate::kept;

#[test]
fn a_measured_report_works_on_a_desk_and_on_a_phone() {
    let Some(mut browser) = Browser::start() else { return };
    let mut renderer = Renderer::new(atrium());
    let content = Content::of(renderer.scene());
    let settings = Settings { size: Size { width: 192, height: 108 }, ..Settings::default() };
    let options = Options {
        methods: vec![Method::TracedRandom, Method::TracedSame, Method::Gtao],
        rays: vec![1, 2, 8],
        runs: 1,
        truth: TruthOptions { bound: 0.01, ..TruthOptions::default() },
        sequence: None,
    };
    let work = Work::new(Control::default(), &|_| ());
    let outcome = experiment::run(&mut renderer, &content, &settings, &options, work).expect("renders");
    let facts = vec![("Scene".to_owned(), "atrium".to_owned())];
    let html = html::page(&document("Atrium".to_owned(), &outcome, facts, "ambray compare".to_owned()));
    std::fs::write(kept("measured.html"), &html).expect("a file");
    for (name, look) in [("measured", Look::DESKTOP), ("measured-phone", Look::PHONE.dark())] {
        let mut page = browser.open_text(&html, look);
        page.screenshot_all(&kept(&format!("{name}.png")));
        report::check(&mut page);
    }
}
