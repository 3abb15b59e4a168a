//! What a reader does to pictures with a mouse, a finger and a keyboard.

use ambray_compare::{
    document::{Block, Document, Picture, Section},
    html,
};
use conformance::browser::{Browser, Look, Page, report};

use crate::{kept, open, sample};

/// Left, upper edge, width and height of what a picture shows, in its pixels.
fn view(page: &mut Page, selector: &str) -> [f64; 4] {
    let text = page.text(&format!("document.querySelector('{selector}').getAttribute('viewBox')"));
    let numbers: Vec<f64> = text.split(' ').map(|number| number.parse().expect("a number")).collect();
    numbers.try_into().expect("four numbers")
}

fn zoom(page: &mut Page) -> String {
    page.text("document.querySelector('.slider .zoom output').textContent")
}

/// What a block says of the pixel under the pointer, when its pictures are decoded.
fn readout(page: &mut Page, block: &str) -> String {
    let text = format!("document.querySelector('{block} .readout').innerText");
    page.wait_until(&format!("/^x /.test({text}) && !{text}.includes('…')"));
    page.text(&text)
}

#[test]
fn the_screen_shows_the_left_picture_left_of_the_divider_and_the_right_one_right_of_it() {
    let Some((_browser, mut page)) = open(Look::DESKTOP) else { return };
    let stage = page.find(".slider .stage");
    page.drag(stage.at(0.5, 0.2), stage.at(0.7, 0.2));
    page.hover((1.0, 1.0));
    page.settle();
    let shot = image::load_from_memory(&page.screenshot(&kept("divider.png"))).expect("a picture").to_rgb8();
    // The middle of the pattern's squares, whose blue tells the pictures apart: 140 in the pattern, 40 in the truth.
    let square = |x: u32, y: u32| {
        let (u, v) = (
            (f64::from(x) + 0.5) / f64::from(sample::WIDTH),
            (f64::from(y) + 0.5) / f64::from(sample::HEIGHT),
        );
        let (x, y) = stage.at(u, v);
        shot.get_pixel(x as u32, y as u32).0
    };
    for x in (2..sample::WIDTH).step_by(8).map(|x| x + 40).take_while(|&x| x < sample::WIDTH - 8) {
        let y = 42;
        let is_left = f64::from(x) < 0.7 * f64::from(sample::WIDTH);
        // Not what the handle covers.
        if (f64::from(x) / f64::from(sample::WIDTH) - 0.7).abs() < 0.03 {
            continue;
        }
        let expected = if is_left { sample::truth(x, y) } else { sample::pattern(x, y) };
        for (seen, value) in square(x, y).into_iter().zip(expected) {
            assert!(seen.abs_diff(value) <= 3, "column {x}: {:?} is not {expected:?}", square(x, y));
        }
    }
}

#[test]
fn keys_move_the_divider_and_choose_pictures() {
    let Some((_browser, mut page)) = open(Look::DESKTOP) else { return };
    let at = "document.querySelector('.divider').getAttribute('aria-valuenow')";
    let chosen = |page: &mut Page| {
        page.text("[...document.querySelectorAll('.slider .picture')].map(p => p.ariaLabel).join(' | ')")
    };
    page.find(".slider .stage");
    page.value("document.querySelector('.divider').focus()");
    for (key, expected) in
        [("ArrowRight", "51"), ("ArrowLeft", "50"), ("ArrowLeft", "49"), ("End", "100"), ("Home", "0")]
    {
        page.press(key);
        assert_eq!(page.text(at), expected, "after {key}");
    }
    assert_eq!(chosen(&mut page), "Truth | Interleaved, 8 rays");
    page.press("4");
    assert_eq!(chosen(&mut page), "GTAO | Interleaved, 8 rays");
    page.press("x");
    assert_eq!(chosen(&mut page), "Interleaved, 8 rays | GTAO");
    // There is no ninth picture.
    page.press("9");
    // The pointer is right of the divider, which is at the left end.
    let stage = page.find(".slider .stage");
    page.hover(stage.at(0.6, 0.5));
    page.press("3");
    assert_eq!(chosen(&mut page), "Interleaved, 8 rays | SSAO <hemisphere>");
    // The menus follow, and the captions.
    let captions =
        page.text("[...document.querySelectorAll('.slider .caption')].map(p => p.innerText).join()");
    assert!(captions.contains("Darkens what \"only\" seems near & is not."), "{captions}");
    let menus = page.text("[...document.querySelectorAll('select')].map(s => s.selectedIndex).join()");
    assert_eq!(menus, "1,2");
    report::assert_clean(&mut page);
}

#[test]
fn help_is_for_who_reads_it() {
    let seen = "document.querySelector('.slider .readout').innerText";
    let Some((_browser, mut page)) = open(Look::DESKTOP) else { return };
    assert!(page.text(seen).contains("Wheel"));
    let Some((_browser, mut page)) = open(Look::PHONE) else { return };
    assert!(page.text(seen).starts_with("Two fingers"));
}

#[test]
fn menus_choose_pictures() {
    let Some((_browser, mut page)) = open(Look::DESKTOP) else { return };
    page.find(".slider");
    page.value("document.querySelector('select[data-side=right]').focus()");
    page.press("ArrowDown");
    page.settle();
    assert_eq!(page.text("document.querySelector('.picture.right').ariaLabel"), "SSAO <hemisphere>");
    let shown = page.text("document.querySelector('.picture.right use').getAttribute('href')");
    assert_eq!(shown, "#picture-2");
    assert_eq!(page.text("document.querySelector('.tag.right').textContent"), "SSAO <hemisphere>");
}

#[test]
fn the_wheel_zooms_at_the_pointer_a_drag_pans_and_a_double_click_resets() {
    let Some((_browser, mut page)) = open(Look::DESKTOP) else { return };
    let stage = page.find(".slider .stage");
    let place = stage.at(0.25, 0.5);
    page.hover(place);
    assert!(readout(&mut page, ".slider").starts_with("x 80, y 90"), "{}", readout(&mut page, ".slider"));
    for _ in 0..4 {
        page.wheel(place, -100.0);
    }
    page.settle();
    // Four steps of √2; pixel (80, 90) stays under the pointer.
    assert_eq!(zoom(&mut page), "4×");
    let expected = [80.0 - 0.25 * 80.0, 90.0 - 0.5 * 45.0, 80.0, 45.0];
    for side in [".slider .left", ".slider .right"] {
        let seen = view(&mut page, &format!(".slider .picture{}", &side[7..].trim()));
        assert!(seen.iter().zip(expected).all(|(a, b)| (a - b).abs() < 0.5), "{side}: {seen:?}");
    }
    let rendering = page.text("getComputedStyle(document.querySelector('.slider .picture')).imageRendering");
    assert_eq!(rendering, "pixelated");
    page.screenshot(&kept("zoomed.png"));
    // To the right by a tenth of the stage: an eighth of what is seen would be 10 pixels, a tenth is 8.
    page.drag(stage.at(0.2, 0.3), stage.at(0.3, 0.3));
    assert!((view(&mut page, ".slider .picture.left")[0] - 52.0).abs() < 0.5);
    let divider = page.text("document.querySelector('.divider').ariaValueNow");
    assert_eq!(divider, "50", "a drag beside the divider pans");
    page.drag(stage.at(0.5, 0.3), stage.at(0.6, 0.3));
    assert_eq!(
        page.text("document.querySelector('.divider').ariaValueNow"),
        "60",
        "its handle still moves it"
    );
    for _ in 0..20 {
        page.wheel(place, -100.0);
    }
    assert_eq!(zoom(&mut page), "32×");
    page.click(place, 2);
    assert_eq!(zoom(&mut page), "1×");
    assert_eq!(view(&mut page, ".slider .picture.left"), [0.0, 0.0, 320.0, 180.0]);
    report::assert_clean(&mut page);
}

#[test]
fn a_wheel_that_turns_back_at_the_whole_picture_scrolls_the_page() {
    let Some((_browser, mut page)) = open(Look::DESKTOP) else { return };
    let stage = page.find(".slider .stage");
    let before = page.number("scrollY");
    page.wheel(stage.at(0.5, 0.5), 120.0);
    page.settle();
    assert_eq!(zoom(&mut page), "1×");
    assert!(page.number("scrollY") > before);
}

#[test]
fn the_readout_says_pixel_and_values() {
    let Some((_browser, mut page)) = open(Look::DESKTOP) else { return };
    let stage = page.find(".slider .stage");
    // Pixel (130, 50): blue of the pattern is 140 where (130 / 4 + 50 / 4) = 32 + 12 is even.
    let (u, v) = (130.5 / 320.0, 50.5 / 180.0);
    page.hover(stage.at(u, v));
    let text = readout(&mut page, ".slider");
    assert!(text.contains("x 130, y 50"), "{text}");
    assert!(text.contains("Truth 130 50 40"), "{text}");
    assert!(text.contains("Interleaved, 8 rays 130 50 140"), "{text}");
    assert!(text.contains("right − left 0 0 +100"), "{text}");
}

#[test]
fn pictures_of_a_gallery_zoom_together() {
    let Some((_browser, mut page)) = open(Look::DESKTOP) else { return };
    let stage = page.find(".gallery .item:nth-child(2) .stage");
    page.hover(stage.at(0.5, 0.5));
    page.press("+");
    page.press("+");
    let views = page.value(
        "[...new Set([...document.querySelectorAll('.gallery .picture')].map(p => p.getAttribute('viewBox')))]",
    );
    assert_eq!(views, serde_json::json!(["120 67.5 80 45"]));
    assert_eq!(zoom(&mut page), "1×", "another block keeps its own");
    let text = readout(&mut page, ".gallery");
    assert!(text.contains("Truth") && text.contains("Interleaved") && text.contains("SSAO"), "{text}");
    page.press("0");
    assert_eq!(view(&mut page, ".gallery .picture"), [0.0, 0.0, 320.0, 180.0]);
}

#[test]
fn fingers_move_the_divider_and_zoom() {
    let Some((_browser, mut page)) = open(Look::PHONE) else { return };
    let stage = page.find(".slider .stage");
    page.swipe(stage.at(0.5, 0.3), stage.at(0.2, 0.3));
    assert_eq!(page.text("document.querySelector('.divider').ariaValueNow"), "20");
    page.pinch([stage.at(0.4, 0.4), stage.at(0.6, 0.6)], [stage.at(0.3, 0.3), stage.at(0.7, 0.7)]);
    assert_eq!(zoom(&mut page), "2×");
    page.settle();
    page.tap(stage.at(0.8, 0.8), 2);
    page.settle();
    assert_eq!(zoom(&mut page), "1×");
    report::assert_clean(&mut page);
}

#[test]
fn large_pictures_are_shown() {
    // Noise of 2560 × 1440 cannot be compressed: a PNG file of eleven megabytes.
    let noise = |x: u32, y: u32| {
        let hash = (x ^ y.rotate_left(16)).wrapping_mul(0x9E37_79B9);
        let hash = (hash ^ (hash >> 15)).wrapping_mul(0x85EB_CA6B);
        let [r, g, b, _] = (hash ^ (hash >> 13)).to_le_bytes();
        [r, g, b]
    };
    let (width, height) = (2560, 1440);
    let png = sample::png(width, height, noise);
    assert!(png.len() > 10_000_000, "{} bytes", png.len());
    let picture = Picture { name: "noise".into(), caption: String::new(), width, height, png };
    let slider = Block::Slider { caption: "Noise".into(), pictures: vec![picture], left: 0, right: 0 };
    let section = Section { title: "Large".into(), blocks: vec![slider] };
    let document = Document { title: "Large".into(), sections: vec![section], ..Document::default() };
    let Some(mut browser) = Browser::start() else { return };
    let mut page = browser.open_text(&html::page(&document), Look::DESKTOP);
    report::check(&mut page);
    let stage = page.find(".stage");
    page.hover(stage.at((200.0 + 0.5) / 2560.0, (99.0 + 0.5) / 1440.0));
    let [r, g, b] = noise(200, 99);
    let text = readout(&mut page, ".slider");
    assert!(text.contains("x 200, y 99") && text.contains(&format!("noise {r} {g} {b}")), "{text}");
    for _ in 0..10 {
        page.wheel(stage.at(0.5, 0.5), -100.0);
    }
    page.hover((1.0, 1.0));
    // 32 times, a pixel of the picture is 13.75 of the screen.
    let [left, top, seen_width, seen_height] = view(&mut page, ".picture.left");
    let (x, y) = stage.at(0.25, 0.25);
    let pixel = noise((left + 0.25 * seen_width) as u32, (top + 0.25 * seen_height) as u32);
    // Large pictures are decoded while the page is already shown.
    let is_seen = (0..40).any(|_| {
        page.settle();
        let shot =
            image::load_from_memory(&page.screenshot(&kept("large.png"))).expect("a picture").to_rgb8();
        shot.get_pixel(x as u32, y as u32).0 == pixel
    });
    assert!(is_seen, "{pixel:?} is not seen at ({x}, {y}) of {}", kept("large.png").display());
}
