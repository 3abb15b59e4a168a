//! Walks through the window by script.

use std::{
    fs,
    process::{Command, Stdio},
};

use crate::{
    display::{Display, Place, assert_quiet, finish, lavapipe, wait_for},
    picture::{Picture, Tolerance},
};

/// Little work, so that pictures are quick.
const QUICK: [&str; 4] = ["--backend", "cpu", "--spp=2", "--radius=1"];
/// Words and lines hide nothing of the picture after this.
const BARE: &str = "resize 1000 640\noverlays off\n";

/// Sizes that follow each other as fast as they do while an edge of the window is dragged.
fn storm() -> String {
    (0..20).map(size).map(|(width, height)| format!("resize {width} {height}\n")).collect()
}

/// Size `i` of the storm.
const fn size(i: usize) -> (usize, usize) {
    (700 + 37 * (i % 7), 420 + 23 * (i % 5))
}

/// The place of the picture of the command line in `line` in `window`: every byte of it is there.
#[track_caller]
fn place_of(place: &Place, window: &Picture, line: &str) -> (Picture, (usize, usize)) {
    let file = format!("{line}.png");
    place.run_line(line, &["--backend", "cpu", "--quiet", "-o", &file]);
    let picture = Picture::read(&place.path(&file));
    let found = window.find(&picture, Tolerance::NONE);
    let found = found.unwrap_or_else(|| panic!("{line}: the picture is not in the window, byte for byte"));
    (picture, found)
}

#[test]
fn the_window_shows_what_the_copied_command_line_renders() {
    let Some(display) = Display::start() else { return };
    let place = Place::new();
    let sizes = storm();
    let walk = "wait\nexpect no-error\nscreenshot beauty.png\ncopy beauty\n\
                aov openness\nset ramp turbo\nset frame 3\nwait\nscreenshot plane.png\ncopy plane\n";
    assert_quiet(&place.walk(&display, &QUICK, &format!("wait\n{sizes}{BARE}{walk}")));
    let window = Picture::read(&place.path("beauty.png"));
    assert_eq!((window.width, window.height), (1000, 640));
    let (picture, _) = place_of(&place, &window, "beauty");
    assert!(picture.colours() > 1000, "{} colours", picture.colours());
    place.run_line("plane", &["--backend", "cpu", "--quiet", "-o", "all.png"]);
    let plane = Picture::read(&place.path("all.openness.png"));
    assert!(plane.colours() > 100, "{} colours", plane.colours());
    let window = Picture::read(&place.path("plane.png"));
    window.find(&plane, Tolerance::NONE).expect("the plane is in the window, byte for byte");
}

#[test]
fn light_that_accumulates_in_the_window_is_that_of_the_copied_sequence() {
    let Some(display) = Display::start() else { return };
    // One scene stands still; in the other one, time does.
    for scene in ["atrium", "banner"] {
        let place = Place::new();
        let more = if scene == "banner" { "set time 0.7\n" } else { "" };
        let walk = format!(
            "{BARE}set size 48x32\nset frame 5\n{more}wait\nset temporal on\nframes 256\nscreenshot window.png\n\
             copy line\n"
        );
        assert_quiet(&place.walk(&display, &[&[scene], &QUICK[..]].concat(), &walk));
        place.run_line("line", &["--backend", "cpu", "--quiet", "-o", "out/####.png"]);
        let (window, last) =
            (Picture::read(&place.path("window.png")), Picture::read(&place.path("out/0255.png")));
        assert!(
            last.colours() > 100
                && !last.is_like(&Picture::read(&place.path("out/0000.png")), Tolerance::NONE)
        );
        // A small picture is shown with as many whole pixels for each of its own as there is room for.
        let found =
            (1..20).rev().find(|&factor| window.find(&last.magnified(factor), Tolerance::NONE).is_some());
        assert!(found.is_some(), "{scene}");
    }
}

#[test]
fn a_vulkan_device_presents_what_it_renders_and_the_validation_layer_is_silent() {
    let (Some(display), Some(driver)) = (Display::start(), lavapipe()) else { return };
    let place = Place::new();
    let sizes = storm();
    let walk = format!(
        "resize 800 480\noverlays off\nwait\nexpect no-error\nscreenshot window.png\ncopy line\n\
         overlays on\nside b\ncompare split\nset spp 3\ndivider 0.25\nwait\nscreenshot split.png\n\
         compare difference\nwait\naov depth\nwait\ndrop nothing.glb\nwait\nexpect error nothing.glb\n\
         compare off\n{sizes}wait\nscreenshot last.png\n"
    );
    fs::write(place.path("walk.txt"), walk).expect("script");
    let arguments = ["--no-memory", "--script", "walk.txt", "--backend", "vulkan", "--validation"];
    let mut command = place.view(&display, &arguments);
    command.args(["--spp=2", "--radius=1"]).env("VK_DRIVER_FILES", &driver).env("VK_ICD_FILENAMES", &driver);
    let child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    assert_quiet(&finish(child.expect("the program starts")));
    // The processor renders the same up to rounding.
    place.run_line("line", &["--backend", "cpu", "--quiet", "-o", "picture.png"]);
    let (window, picture) =
        (Picture::read(&place.path("window.png")), Picture::read(&place.path("picture.png")));
    assert!(picture.colours() > 1000, "{} colours", picture.colours());
    window.find(&picture, Tolerance::PARITY).expect("the picture is in the window");
    let split = Picture::read(&place.path("split.png"));
    assert!(!split.is_like(&window, Tolerance::PARITY), "the divider is drawn");
    let last = Picture::read(&place.path("last.png"));
    assert_eq!((last.width, last.height), size(19));
}

#[test]
fn the_divider_says_which_side_is_seen() {
    let Some(display) = Display::start() else { return };
    let place = Place::new();
    let walk = "compare split\nset spp 2\nside b\nset spp 7\ncopy b\nside a\ncopy a\n\
                divider 0.3\nwait\nscreenshot left.png\ndivider 0.7\nwait\nscreenshot right.png\n\
                divider 0\nwait\nscreenshot only-b.png\ndivider 1\nwait\nscreenshot only-a.png\nexpect no-error\n";
    let wait = "wait\n";
    assert_quiet(&place.walk(&display, &QUICK, &format!("{BARE}{wait}{walk}")));
    let window = |name: &str| Picture::read(&place.path(name));
    let (a, found) = place_of(&place, &window("only-a.png"), "a");
    let (b, _) = place_of(&place, &window("only-b.png"), "b");
    let differing = a.differing_columns(&b);
    assert!(differing.len() > a.width / 2, "{} columns", differing.len());
    let shown = |name: &str| window(name).part(found, a.width, a.height);
    let (left, right) = (shown("left.png"), shown("right.png"));
    // Between its two places the divider uncovers A; everywhere else nothing changes.
    let left_edge = found.0 as f32;
    let at = |share: f32| ((left_edge + share * a.width as f32).round() - left_edge) as usize;
    let crossed: Vec<usize> = differing.iter().copied().filter(|x| (at(0.3)..at(0.7)).contains(x)).collect();
    assert_eq!(left.differing_columns(&right), crossed);
    let beyond = |x: &usize| *x >= at(0.7);
    assert!(right.differing_columns(&a).iter().all(beyond) && left.differing_columns(&a).iter().any(beyond));
}

#[test]
fn a_bad_file_that_is_dropped_says_so_and_the_picture_stays() {
    let Some(display) = Display::start() else { return };
    let place = Place::new();
    fs::write(place.path("bad.glb"), "glTF, or rather not").expect("file");
    let walk = "wait\nscreenshot before.png\ndrop bad.glb\nwait\nexpect error bad.glb\nscreenshot after.png\ncopy line\n\
                overlays on\nwait\nscreenshot told.png\n";
    assert_quiet(&place.walk(&display, &QUICK, &format!("{BARE}{walk}")));
    let window = |name: &str| Picture::read(&place.path(name));
    let (picture, found) = place_of(&place, &window("before.png"), "line");
    let shown = |name: &str| window(name).part(found, picture.width, picture.height);
    assert!(shown("after.png") == picture, "the picture stays");
    assert!(shown("told.png") != picture, "the error is shown");
}

#[test]
fn ctrl_c_closes_the_window_and_leaves_no_file_half_written() {
    let Some(display) = Display::start() else { return };
    let place = Place::new();
    fs::write(place.path("walk.txt"), "wait\nturntable turn.gif 100000\nwait\n").expect("script");
    let arguments = [&["--memory", "view.toml", "--script", "walk.txt"], &QUICK[..]].concat();
    let child = place.view(&display, &arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn();
    let child = child.expect("the program starts");
    let files = || {
        let entries = fs::read_dir(place.path(".")).expect("a folder").flatten();
        let mut names: Vec<_> =
            entries.map(|entry| entry.file_name().to_string_lossy().into_owned()).collect();
        names.retain(|name| name != "config");
        names.sort();
        names
    };
    // Some frames are written, to a file that will be named when it is complete.
    let is_growing = |name: &String| {
        name.ends_with(".tmp") && fs::metadata(place.path(name)).is_ok_and(|file| file.len() > 10_000)
    };
    wait_for("a file that is being written", || files().iter().any(is_growing).then_some(()));
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(killed.expect("kill").success());
    let output = finish(child);
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!((output.status.code(), &*said), (Some(130), "ambray: interrupted\n"));
    // In order: what is to be remembered is written.
    assert_eq!(files(), ["view.toml", "walk.txt"]);
}

#[test]
fn without_a_graphics_card_the_window_opens_all_the_same() {
    let Some(display) = Display::start() else { return };
    let place = Place::new();
    let output = place.walk(&display, &["--spp=1"], "wait\nscreenshot shown.png\n");
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(place.path("shown.png").exists());
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
