//! The tests would hear of what must not be.

use ambray_compare::html::page;
use conformance::browser::{Browser, Look};

use crate::sample;

/// What the browser says of `html`.
fn complaints(html: &str) -> Option<Vec<String>> {
    Some(Browser::start()?.open_text(html, Look::DESKTOP).complaints())
}

#[test]
fn warnings_exceptions_and_requests_are_heard() {
    let html =
        "<!doctype html><title>bad</title><script>console.warn('beware'); throw Error('thrown')</script>
        <img src='http://127.0.0.1:9/picture.png'>";
    let Some(complaints) = complaints(html) else { return };
    for expected in ["beware", "thrown", "request: http://127.0.0.1:9/picture.png"] {
        assert!(
            complaints.iter().any(|complaint| complaint.contains(expected)),
            "{expected}: {complaints:?}"
        );
    }
}

#[test]
fn the_policy_of_the_page_forbids_what_is_smuggled_into_it() {
    let smuggled = "<img src='http://127.0.0.1:9/x.png'><script>document.title = 'taken'</script>
        <link rel=stylesheet href='http://127.0.0.1:9/x.css'></main>";
    let html = page(&sample::document()).replace("</main>", smuggled);
    let Some(mut browser) = Browser::start() else { return };
    let mut page = browser.open_text(&html, Look::DESKTOP);
    assert_eq!(page.text("document.title"), "Ambray against the truth: atrium");
    let complaints = page.complaints();
    for forbidden in ["script", "x.png", "x.css"] {
        let is_said = |text: &String| text.contains("Content Security Policy") && text.contains(forbidden);
        assert!(complaints.iter().any(is_said), "{forbidden}: {complaints:?}");
    }
}
