//! Walks through the window by script.

use std::fs;

use crate::{
    display::{Display, Place, assert_quiet, lavapipe},
    picture::{Picture, differing},
};

/// A small window, so that pictures are quick.
const QUICK: [&str; 2] = ["--spp=2", "--radius=1"];

#[test]
fn the_window_shows_what_the_copied_command_line_renders() {
    let Some(display) = Display::start() else { return };
    let place = Place::new();
    let walk = "resize 1440 900\nwait\nexpect no-error\nscreenshot window.png\ncopy line.txt\n";
    let arguments = [&["--backend", "cpu"], &QUICK[..]].concat();
    assert_quiet(&place.walk(&display, &arguments, walk));
    place.run_line("line.txt", &["--backend", "cpu", "--quiet", "-o", "picture.png"]);
    let (window, picture) =
        (Picture::read(&place.path("window.png")), Picture::read(&place.path("picture.png")));
    assert_eq!((window.width, window.height), (1440, 900));
    assert!(picture.colours() > 1000, "{} colours", picture.colours());
    let found = window.find(&picture, 0).expect("the picture is in the window, byte for byte");
    let (anywhere, middle) = differing(&window, &picture, found, 0);
    assert_eq!(middle, 0.0);
    assert!(anywhere < 0.06, "labels cover {anywhere}");
}

#[test]
fn a_vulkan_device_presents_what_it_renders_and_the_validation_layer_is_silent() {
    let (Some(display), Some(driver)) = (Display::start(), lavapipe()) else { return };
    let place = Place::new();
    let walk = "resize 1300 700\nwait\nexpect no-error\nscreenshot window.png\ncopy line.txt\n\
                resize 1200 640\nset spp 1\nside b\ncompare split\nset spp 3\ndivider 0.25\nwait\nscreenshot split.png\n\
                drop nothing.glb\nwait\nexpect error nothing.glb\nexpect error No such\nresize 1300 700\nwait\n";
    fs::write(place.path("walk.txt"), walk).expect("script");
    let mut command =
        place.view(&display, &["--no-memory", "--script", "walk.txt", "--backend", "vulkan", "--validation"]);
    command.args(QUICK).env("VK_DRIVER_FILES", &driver).env("VK_ICD_FILENAMES", &driver);
    let child = command.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped()).spawn();
    assert_quiet(&crate::display::finish(child.expect("the program starts")));
    // The processor renders the same up to rounding.
    place.run_line("line.txt", &["--backend", "cpu", "--quiet", "-o", "picture.png"]);
    let (window, picture) =
        (Picture::read(&place.path("window.png")), Picture::read(&place.path("picture.png")));
    let found = window.find(&picture, 2).expect("the picture is in the window");
    let (_, middle) = differing(&window, &picture, found, 2);
    assert!(middle < 0.005, "{middle} of the pixels differ");
    let split = Picture::read(&place.path("split.png"));
    assert_eq!((split.width, split.height), (1200, 640));
}

#[test]
fn the_divider_says_which_side_is_seen() {
    let Some(display) = Display::start() else { return };
    let place = Place::new();
    let walk = "resize 1300 700\nside b\nset exposure 1.5\nside a\ncompare split\n\
                divider 0.3\nwait\nscreenshot left.png\ndivider 0.7\nwait\nscreenshot right.png\nexpect no-error\n";
    let arguments = [&["--backend", "cpu"], &QUICK[..]].concat();
    let walk = walk.replace("exposure 1.5", "spp 7");
    assert_quiet(&place.walk(&display, &arguments, &walk));
    let (left, right) = (Picture::read(&place.path("left.png")), Picture::read(&place.path("right.png")));
    let differs = |x: usize| (0..left.height).any(|y| left.at(x, y) != right.at(x, y));
    let columns: Vec<usize> = (0..left.width).filter(|&x| differs(x)).collect();
    let (first, last) = (columns[0], columns[columns.len() - 1]);
    // What lies between the two places of the divider was B and is A.
    // The canvas is about 430 pixels wide beside the panels, of which the divider crosses four tenths.
    assert!(last - first > 150, "columns {first} to {last}");
    assert!(columns.len() > (last - first) / 2);
}

#[test]
fn a_bad_file_that_is_dropped_says_so_and_the_picture_stays() {
    let Some(display) = Display::start() else { return };
    let place = Place::new();
    fs::write(place.path("bad.glb"), "glTF, or rather not").expect("file");
    let walk = "resize 1300 700\nwait\nscreenshot before.png\ndrop bad.glb\nwait\nexpect error bad.glb\n\
                screenshot after.png\ncopy line.txt\n";
    let arguments = [&["--backend", "cpu"], &QUICK[..]].concat();
    assert_quiet(&place.walk(&display, &arguments, walk));
    let (before, after) = (Picture::read(&place.path("before.png")), Picture::read(&place.path("after.png")));
    let same = before.rgb.iter().zip(&after.rgb).filter(|(a, b)| a == b).count();
    assert!(same != before.rgb.len(), "nobody was told");
    assert!(same * 10 > before.rgb.len() * 7, "{same} of {} pixels stayed", before.rgb.len());
}

#[test]
fn a_script_that_fails_names_its_line() {
    let Some(display) = Display::start() else { return };
    let place = Place::new();
    for (script, why) in [
        ("wait\nexpect error fire\n", "walk.txt:2: expected an error with 'fire'"),
        ("set colour red\n", "walk.txt:1: "),
        ("paint\n", "walk.txt:1: no step is called 'paint'"),
    ] {
        let output = place.walk(&display, &["--backend", "cpu", "--spp=1"], script);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{said}");
        assert!(said.contains(why), "{said}");
    }
}

#[test]
fn without_a_display_there_is_one_clear_line() {
    let place = Place::new();
    let output = place.program().arg("view").output().expect("the program starts");
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(2), "{said}");
    let line = "ambray: error: there is no display to open a window on: neither DISPLAY nor WAYLAND_DISPLAY is set\n";
    assert_eq!(said, line);
}
