//! The panels, worked by their labels and by keys, without a window.

mod desk;

use std::sync::Arc;

use ambray::{
    Machine,
    settings::{Auto, Kind, Method, Settings, Temporal, Thin, Window},
    vulkan::TraceMode,
};
use ambray_view::{
    app::Severity,
    model::{Comparison, SceneRef, Side},
    panels::action::{Action, Question},
};
use desk::{Desk, Dropped};
use egui::{Key, Modifiers, accesskit::Role};
use egui_kittest::kittest::{NodeT as _, Queryable as _};

#[test]
fn every_setting_has_an_editor() {
    let mut desk = Desk::new();
    desk.open_all_groups();
    for field in Settings::fields() {
        let name = field.name.replace('-', " ");
        let editors: Vec<_> = desk.harness.query_all_by_label(&name).collect();
        assert!(!editors.is_empty(), "{name} has no editor");
        if field.kind.has_auto() {
            desk.harness.get_by_label(&format!("{name} auto"));
        }
    }
}

#[test]
fn flags_and_numbers_are_changed_by_their_widgets_and_reset_by_a_click() {
    let mut desk = Desk::new();
    desk.open_all_groups();
    desk.click("lights");
    assert!(!desk.settings().lights);
    desk.click("reset lights");
    assert!(desk.settings().lights);

    let spp = desk.harness.get_by_role_and_label(Role::Slider, "spp");
    spp.scroll_to_me();
    desk.step(3);
    desk.harness.get_by_role_and_label(Role::Slider, "spp").focus();
    desk.step(2);
    desk.harness.key_press(Key::ArrowRight);
    desk.step(2);
    let changed = desk.settings().spp;
    assert!(changed > 1, "{changed}");
    desk.click("reset Ambient light");
    assert_eq!(desk.settings().spp, Settings::default().spp);
}

#[test]
fn choices_are_chosen_with_their_meanings_beside_them() {
    let mut desk = Desk::new();
    desk.open_all_groups();
    for field in Settings::fields() {
        let Kind::Choice(choices) = field.kind else { continue };
        let name = field.name.replace('-', " ");
        let current = desk.settings().get(field.name).unwrap();
        let (other, _) = choices.iter().find(|(name, _)| *name != current).unwrap();
        desk.click(&name);
        desk.harness.get_by_role_and_label(Role::Button, other).click();
        desk.step(3);
        assert_eq!(desk.settings().get(field.name).as_deref(), Some(*other), "{name}");
    }
}

#[test]
fn auto_begins_with_what_it_became() {
    let mut desk = Desk::new();
    desk.wait();
    desk.open_all_groups();
    let became = desk.app().shown.sides[0].as_ref().unwrap().view.radius;
    desk.click("radius auto");
    assert_eq!(desk.settings().radius, Auto::Value(became));
    desk.click("radius auto");
    assert_eq!(desk.settings().radius, Auto::Auto);
}

#[test]
fn the_search_shows_what_it_finds_in_names_and_meanings() {
    let mut desk = Desk::new();
    desk.harness.get_by_label("search settings").focus();
    desk.step(1);
    desk.harness.get_by_label("search settings").type_text("tangent");
    desk.step(3);
    desk.harness.get_by_label("filter plane");
    assert!(desk.harness.query_by_label("lights").is_none());
}

#[test]
fn each_side_is_edited_by_itself_and_a_comparison_that_ends_goes_back_to_a() {
    let mut desk = Desk::new();
    desk.open_all_groups();
    desk.click("A | B");
    assert_eq!(desk.app().model.comparison, Comparison::Split);
    desk.click("edit side B");
    assert_eq!(desk.app().model.editing, Side::B);
    desk.click("lights");
    let [a, b] = &desk.app().model.settings;
    assert_eq!((a.lights, b.lights), (true, false));
    desk.click("edit side A");
    assert_eq!(desk.app().model.editing, Side::A);
    desk.click("edit side B");
    desk.click("A");
    let model = &desk.app().model;
    assert_eq!((model.editing, model.comparison), (Side::A, Comparison::Off));
}

#[test]
fn pairs_that_are_often_compared_are_one_click_away() {
    let mut desk = Desk::new();
    let mut choose = |name: &str| {
        desk.click("Compare");
        desk.click(name);
        let model = &desk.app().model;
        assert_eq!(model.comparison, Comparison::Split, "{name}");
        model.settings.clone()
    };
    let [a, b] = choose("thin off | sheet");
    assert_eq!((a.thin, b.thin), (Thin::Off, Thin::Sheet));
    let [a, b] = choose("4 | 8 rays per pixel");
    assert_eq!((a.spp, b.spp), (4, 8));
    let [a, b] = choose("filtered | raw");
    assert_eq!((a.filter, b.filter), (Window::Centred, Window::Off));
    let [a, b] = choose("this | converged reference");
    assert_eq!((a.spp, b.spp), (4, 1024));
    desk.click("Compare");
    desk.click("Swap A and B");
    let [a, b] = &desk.app().model.settings;
    assert_eq!((a.spp, b.spp), (1024, 4));
    desk.click("Compare");
    desk.click("Copy A to B");
    let [a, b] = &desk.app().model.settings;
    assert_eq!(a, b);
}

#[test]
fn the_command_line_names_what_differs_and_the_plane() {
    let mut desk = Desk::new();
    desk.wait();
    desk.app_mut().set("thin", "sheet").unwrap();
    desk.app_mut().set("exposure", "0.1").unwrap();
    desk.app_mut().model.aov = ambray::Aov::Depth;
    desk.step(2);
    desk.click("Copy as command line");
    let line = desk.app().copied().expect("the line is copied").to_owned();
    assert!(line.starts_with("ambray render atrium "), "{line}");
    for part in ["--thin=sheet", "--exposure=0.1", "--spp=1", "--backend=cpu", "--aov=depth", "-o ambray.png"]
    {
        assert!(line.contains(part), "{line} lacks {part}");
    }
    let size = desk.settings().size;
    assert!(line.contains(&format!("--size={size}")), "{line}");
    // Read back word by word, it is the settings again.
    let mut settings = Settings::default();
    for word in line.split(' ').filter_map(|word| word.strip_prefix("--")) {
        let (name, value) = word.split_once('=').unwrap();
        if !["aov", "backend"].contains(&name) {
            settings.set(name, value).unwrap();
        }
    }
    assert_eq!(&settings, desk.settings());
}

/// Lets the scene be open on a device, and the picture of side A be rendered by `machine`.
fn pretend_a_device(desk: &mut Desk, machine: Machine) {
    let device = Machine::Vulkan { device: "A card".to_owned(), trace: TraceMode::Query };
    let shown = &mut desk.app_mut().shown;
    Arc::make_mut(shown.opened.as_mut().unwrap()).machine = device;
    shown.sides[0].as_mut().unwrap().machine = machine;
}

#[test]
fn the_command_line_names_no_device_that_would_refuse_the_method() {
    let mut desk = Desk::new();
    desk.wait();
    let device = Machine::Vulkan { device: "A card".to_owned(), trace: TraceMode::Query };
    pretend_a_device(&mut desk, device);
    assert!(desk.app().command_line(Side::A).contains("--backend=vulkan"));
    desk.app_mut().set("method", "ssao").unwrap();
    desk.step(1);
    let line = desk.app().command_line(Side::A);
    assert!(line.contains("--method=ssao") && !line.contains("--backend=vulkan"), "{line}");
    desk.wait();
    // A device that gave up has no part in the picture either.
    let reason = Some("the device is lost".to_owned());
    pretend_a_device(&mut desk, Machine::Cpu { isa: "scalar", reason });
    assert!(!desk.app().command_line(Side::A).contains("--backend"));
}

#[test]
fn the_machine_of_a_picture_is_who_rendered_it() {
    let mut desk = Desk::new();
    desk.wait();
    let device = Machine::Vulkan { device: "A card".to_owned(), trace: TraceMode::Query };
    let reason = Some("the method ssao runs there only".to_owned());
    let processor = Machine::Cpu { isa: "scalar", reason };
    pretend_a_device(&mut desk, device.clone());
    desk.step(2);
    desk.harness.get_by_label("A card");
    pretend_a_device(&mut desk, processor.clone());
    desk.step(2);
    desk.harness.get_by_label("processor, scalar");
    desk.harness.get_by_label("On the processor: the method ssao runs there only");
    assert!(desk.harness.query_by_label("A card").is_none());
    // Two pictures, two machines.
    desk.click("A | B");
    desk.wait();
    pretend_a_device(&mut desk, processor);
    desk.app_mut().shown.sides[1].as_mut().unwrap().machine = device;
    desk.step(2);
    for label in ["machine A", "processor, scalar", "machine B", "A card"] {
        desk.harness.get_by_label(label);
    }
}

#[test]
fn what_a_method_cannot_do_is_not_offered() {
    let mut desk = Desk::new();
    desk.wait();
    desk.open_all_groups();
    assert!(!desk.harness.get_by_label("accumulate").accesskit_node().is_disabled());
    desk.app_mut().set("method", "gtao").unwrap();
    desk.step(3);
    assert!(desk.harness.get_by_label("accumulate").accesskit_node().is_disabled());
    desk.harness.get_by_label("accumulate").hover();
    desk.pass(2);
    desk.harness.get_by_label("temporal on is not allowed: off where the method works in screen space");
    desk.click("thin");
    let sheet = desk.harness.get_by_role_and_label(Role::Button, "sheet");
    assert!(sheet.accesskit_node().is_disabled());
    sheet.click();
    desk.step(3);
    assert_eq!(desk.settings().thin, Thin::Off);
    desk.harness.key_press(Key::Escape);
    desk.step(3);
    desk.click("Compare");
    assert!(desk.harness.get_by_label("thin off | sheet").accesskit_node().is_disabled());
    desk.click("this | converged reference");
    let [a, b] = &desk.app().model.settings;
    assert_eq!((a.method, b.method, b.spp), (Method::Gtao, Method::Ambray, 1024));
}

#[test]
fn a_method_says_what_it_does_not_go_with_and_how_to_go_on() {
    let mut desk = Desk::new();
    desk.wait();
    desk.app_mut().set("thin", "sheet").unwrap();
    desk.app_mut().set("temporal", "on").unwrap();
    desk.app_mut().set("method", "hbao").unwrap();
    desk.step(3);
    // Also where all groups are closed.
    desk.app_mut().memory.panels.open_groups.clear();
    desk.harness.run_steps(20);
    desk.harness.get_by_label("The picture stays as it was: thin and temporal are not allowed");
    desk.harness.get_by_label("not allowed");
    assert!(
        !desk.harness.get_by_label("accumulate").accesskit_node().is_disabled(),
        "it can be switched off"
    );
    desk.open_all_groups();
    desk.harness.get_by_label("hbao does not go with thin and temporal");
    desk.click("Reset thin and temporal");
    let settings = desk.settings();
    assert_eq!((settings.method, settings.thin, settings.temporal), (Method::Hbao, Thin::Off, Temporal::Off));
    desk.wait();
    assert_eq!(desk.app().shown.sides[0].as_ref().unwrap().settings.method, Method::Hbao);
    assert!(desk.harness.query_by_label_contains("not allowed").is_none());
}

#[test]
fn another_scene_is_looked_at_from_its_own_cameras() {
    let mut desk = Desk::new();
    desk.wait();
    desk.app_mut().set("thin", "sheet").unwrap();
    desk.app_mut().set("camera", "1").unwrap();
    desk.app_mut().set("camera-position", "1,2,3").unwrap();
    desk.step(2);
    desk.app_mut().model.scene = SceneRef::new("banner");
    desk.until(|app| {
        app.shown.opened.as_ref().is_some_and(|opened| opened.scene.path.as_os_str() == "banner")
    });
    desk.wait();
    for settings in &desk.app().model.settings {
        assert_eq!((&settings.camera, &settings.camera_position), (&Auto::Auto, &Auto::Auto));
    }
    assert_eq!(desk.settings().thin, Thin::Sheet, "what fits every scene stays");
    assert_eq!(desk.app().shown.refused, [Vec::<String>::new(), Vec::new()]);
}

#[test]
fn what_is_not_allowed_is_said_beside_the_setting_and_the_picture_stays() {
    let mut desk = Desk::new();
    desk.wait();
    desk.open_all_groups();
    let before = desk.app().shown.sides[0].as_ref().unwrap().settings.clone();
    desk.app_mut().set("filter-cos-normal", "7").unwrap();
    desk.step(4);
    desk.harness.get_by_label_contains("7 is not allowed: -1 to 1");
    desk.wait();
    assert_eq!(desk.app().shown.sides[0].as_ref().unwrap().settings, before);
    desk.click("reset filter cos normal");
    assert!(desk.settings().validate().is_empty());
}

#[test]
fn files_that_cannot_be_used_are_told_and_the_scene_stays() {
    let mut desk = Desk::new();
    desk.wait();
    desk.drop_file("notes.txt");
    assert!(desk.app().error().unwrap().contains("notes.txt: neither a scene"));
    desk.harness.get_by_label_contains("neither a scene");
    assert_eq!(desk.app().model.scene, SceneRef::new("atrium"));

    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("broken.gltf");
    std::fs::write(&path, "{ this is no scene").unwrap();
    desk.drop_file(path.to_str().unwrap());
    desk.until(|app| app.error().is_some_and(|error| error.contains("broken.gltf")));
    assert_eq!(desk.app().shown.opened.as_ref().unwrap().scene, SceneRef::new("atrium"));
    assert!(desk.app().shown.sides[0].is_some());
}

#[test]
fn settings_are_saved_and_dropped_back() {
    let mut desk = Desk::new();
    desk.wait();
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("look.toml");
    desk.app_mut().set("thin", "paper").unwrap();
    desk.app_mut().set("camera-position", "1,2,-3.5").unwrap();
    let saved = desk.settings().clone();
    desk.perform(Action::SaveSettings(path.clone()));
    desk.until(|app| app.shown.notices.iter().any(|notice| notice.text.contains("is written")));
    desk.app_mut().set("thin", "off").unwrap();
    desk.app_mut().set("camera-position", "auto").unwrap();
    desk.drop_file(path.to_str().unwrap());
    desk.until(|app| app.model.of(Side::A).thin == Thin::Paper);
    assert_eq!(desk.settings(), &saved);

    std::fs::write(&path, "raduis = 1").unwrap();
    desk.drop_file(path.to_str().unwrap());
    desk.until(|app| app.error().is_some_and(|error| error.contains("did you mean radius")));
    assert_eq!(desk.settings(), &saved);
}

#[test]
fn the_help_opens_by_its_key_and_lists_the_keys() {
    let mut desk = Desk::new();
    assert!(!desk.app().is_help_open());
    desk.harness.key_press_modifiers(Modifiers::SHIFT, Key::Questionmark);
    desk.step(3);
    assert!(desk.app().is_help_open());
    desk.harness.get_by_label("Keys and mouse");
    desk.harness.get_by_label("Open a scene");
    for action in ambray_view::canvas::ACTIONS {
        assert!(desk.harness.query_all_by_label(action.meaning).count() > 0, "{}", action.keys);
    }
    desk.harness.key_press(Key::F1);
    desk.step(2);
    assert!(!desk.app().is_help_open());
}

#[test]
fn changes_are_undone_and_made_again_by_keys() {
    let mut desk = Desk::new();
    desk.open_all_groups();
    desk.click("lights");
    assert!(!desk.settings().lights);
    desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::Z);
    desk.step(2);
    assert!(desk.settings().lights);
    desk.harness.key_press_modifiers(Modifiers::COMMAND, Key::Y);
    desk.step(2);
    assert!(!desk.settings().lights);
}

#[test]
fn bookmarks_are_kept_and_found_again_by_keys_and_belong_to_their_scene() {
    let mut desk = Desk::new();
    desk.wait();
    desk.app_mut().set("camera-position", "1,2,3").unwrap();
    desk.step(1);
    desk.harness.key_press_modifiers(Modifiers::SHIFT, Key::Num2);
    desk.step(2);
    desk.app_mut().set("camera-position", "auto").unwrap();
    desk.step(1);
    desk.harness.key_press(Key::Num2);
    desk.step(2);
    assert_eq!(desk.settings().get("camera-position").as_deref(), Some("1,2,3"));
    desk.app_mut().model.scene = SceneRef::new("banner");
    desk.wait();
    assert!(desk.app().model.bookmarks.is_empty());
    desk.app_mut().model.scene = SceneRef::new("atrium");
    desk.wait();
    assert_eq!(desk.app().model.bookmarks.len(), 1);
}

#[test]
fn an_animation_plays_steps_and_rests() {
    let mut desk = Desk::new();
    desk.wait();
    desk.harness.key_press(Key::Space);
    desk.step(2);
    assert!(!desk.app().model.playback.is_playing, "the atrium does not move");
    desk.app_mut().model.scene = SceneRef::new("banner");
    desk.wait();
    desk.harness.key_press(Key::Period);
    desk.step(2);
    assert_eq!(desk.settings().time, Auto::Value(1.0 / 24.0));
    desk.harness.key_press(Key::Space);
    desk.until(|app| app.model.of(Side::A).time.unwrap_or(0.0) > 0.1);
    assert!(desk.app().model.playback.is_playing);
    desk.click("Rest");
    assert_eq!(desk.settings().time, Auto::Auto);
    assert!(!desk.app().model.playback.is_playing);
}

#[test]
fn panels_are_hidden_and_shown_by_a_key() {
    let mut desk = Desk::new();
    desk.harness.key_press(Key::Tab);
    desk.step(3);
    assert!(desk.harness.query_by_label("Reset all").is_none());
    desk.harness.key_press(Key::Tab);
    desk.step(3);
    desk.harness.get_by_label("Reset all");
}

#[test]
fn editors_fit_their_panel_and_the_picture_keeps_half_of_the_window() {
    let mut desk = Desk::new();
    desk.wait();
    for (width, height) in [(1600.0, 1000.0), (1000.0, 640.0), (1000.0, 2400.0)] {
        desk.harness.set_size(egui::vec2(width, height));
        desk.open_all_groups();
        let picture = desk.harness.get_by_label("picture").rect();
        // But for the margin that the test kit leaves around everything.
        assert!(picture.width() >= 0.5 * width - 16.0, "{picture:?} of {width}");
        for field in Settings::fields() {
            let name = field.name.replace('-', " ");
            for node in desk.harness.query_all_by_label(&name) {
                let editor = node.rect();
                let fits = editor.right() <= picture.left() || editor.left() >= picture.right();
                assert!(fits, "{name} at {width}: {editor:?} reaches into {picture:?}");
            }
        }
        desk.step(10);
        assert_eq!(desk.harness.get_by_label("picture").rect(), picture, "the panels grow");
    }
}

#[test]
fn a_turntable_that_is_being_planned_is_not_begun_anew() {
    let mut desk = Desk::new();
    let ask = Action::Ask(Question::Turntable { frames: 120, fps: 30.0 });
    for _ in 0..2 {
        desk.perform(ask.clone());
        desk.harness.get_by_label("Choose where\u{2026}");
        desk.harness.get_by_label("frames of the turn");
    }
    desk.click("Cancel");
    assert!(desk.harness.query_by_label("frames of the turn").is_none());
}

#[test]
fn presets_are_chosen_and_kept_by_name() {
    let mut desk = Desk::new();
    desk.click("Presets");
    desk.click("draft");
    assert_eq!(desk.settings().spp, 4);
    let look = ambray_view::memory::look_of(desk.settings());
    desk.app_mut().memory.presets.insert("mine".to_owned(), look);
    desk.app_mut().set("spp", "2").unwrap();
    desk.click("Presets");
    desk.click("mine");
    assert_eq!(desk.settings().spp, 4);
}

#[test]
fn good_news_fades_and_errors_stay_until_they_are_dismissed() {
    let mut desk = Desk::new();
    desk.app_mut().shown.notify(Severity::Done, "it is done");
    desk.app_mut().shown.notify(Severity::Error, "it failed");
    desk.step(2);
    desk.harness.get_by_label("it is done");
    desk.pass(30);
    assert!(desk.harness.query_by_label("it is done").is_none());
    desk.harness.get_by_label("it failed");
    desk.click("x");
    assert_eq!(desk.app().error(), None);
}

#[test]
fn dropped_files_have_the_path_they_came_from() {
    assert_eq!(egui::DroppedFile::path(&Dropped("a/b.glb".into())), std::path::Path::new("a/b.glb"));
    let desk = Desk::new();
    assert!(desk.harness.root().accesskit_node().role() == Role::Window);
}
