//! The canvas in a window that does not exist: what hand and keys do to the model.

use std::sync::Arc;

use ambray::{
    Aov, Control, Renderer, RendererOptions,
    scene::atrium,
    settings::{Settings, Size},
};
use egui::{Event, Key, Modifiers, MouseWheelUnit, PointerButton, Pos2, TouchPhase, Vec2, pos2, vec2};
use egui_kittest::{
    Harness,
    kittest::{NodeT as _, Queryable as _},
};

use super::*;
use crate::{
    camera::Lens,
    engine::{Content, EngineOptions, Inspected, Level, Opened, Pixels, Wake},
    model::SceneRef,
};

/// Where the canvas is: the test kit leaves a margin.
const CANVAS: Rect = Rect { min: pos2(8.0, 8.0), max: pos2(328.0, 208.0) };

struct State {
    canvas: Canvas,
    model: Model,
    shown: Shown,
    engine: Engine,
    renderer: Renderer,
}

impl State {
    fn viewpoint(&self) -> Viewpoint {
        viewpoint(&self.model, &self.shown).expect("there is a picture")
    }
}

/// A canvas that shows the atrium on both sides, with everything that a click can hit.
fn harness() -> Harness<'static, State> {
    let settings = Settings { size: Size { width: 320, height: 200 }, spp: 1, ..Settings::default() };
    let mut renderer = Renderer::new(atrium::atrium());
    let frame = renderer.render(&settings, Control::default()).expect("renders");
    let scene = SceneRef::new("atrium");
    let shown = Shown {
        opened: Some(Arc::new(Opened {
            scene: scene.clone(),
            bounds: renderer.scene().bounds().expect("is not empty"),
            ..opened(&renderer)
        })),
        sides: Side::ALL.map(|side| Some(rendered(side, &settings, &frame))),
        ..Shown::default()
    };
    let wake = Wake(Arc::new(|| ()));
    let engine = Engine::new(EngineOptions {
        renderer: RendererOptions::default(),
        threads: 1,
        keeps_on_device: false,
        wake,
    });
    let state =
        State { canvas: Canvas::default(), model: Model::new(scene, settings), shown, engine, renderer };
    let show = |ui: &mut Ui, state: &mut State| {
        state.canvas.show(ui, &mut state.model, &mut state.shown, &state.engine);
    };
    let mut harness = Harness::builder()
        .with_size(CANVAS.size() + Vec2::splat(16.0))
        .with_max_steps(60)
        .with_step_dt(1.0 / 60.0)
        .build_ui_state(show, state);
    harness.step();
    harness
}

fn opened(renderer: &Renderer) -> Opened {
    Opened {
        scene: SceneRef::new("atrium"),
        warnings: Vec::new(),
        load_time: std::time::Duration::ZERO,
        build: renderer.build_stats(),
        machine: renderer.machine(),
        cameras: Vec::new(),
        animations: Vec::new(),
        bounds: Default::default(),
        is_reload: false,
    }
}

fn rendered(side: Side, settings: &Settings, frame: &ambray::Frame) -> Rendered {
    let (width, height) = (frame.width, frame.height);
    let pixels = Arc::new(Pixels { width, height, rgba: vec![128; 4 * (width * height) as usize] });
    Rendered {
        side,
        settings: settings.clone(),
        aov: Aov::Beauty,
        view: frame.view.clone(),
        machine: ambray::Machine::Cpu { isa: ambray::Isa::detect().name(), reason: None },
        level: Level { scale: 1.0, spp: 1, is_final: true },
        frames: 1,
        content: Content::Host { frame: Arc::new(frame.clone()), pixels },
        statistics: None,
        stats: frame.stats,
        frame_bytes: 0,
    }
}

fn button(
    harness: &Harness<'_, State>,
    pos: Pos2,
    button: PointerButton,
    pressed: bool,
    modifiers: Modifiers,
) {
    harness.event(Event::PointerButton { pos, button, pressed, modifiers });
}

/// Keeps these keys pressed.
fn hold(harness: &mut Harness<'_, State>, modifiers: Modifiers) {
    harness.event(Event::ModifiersChanged(modifiers));
    harness.step();
}

/// Presses, moves and lets go; `during` looks at the state before that.
fn drag_with(
    harness: &mut Harness<'_, State>,
    from: Pos2,
    by: Vec2,
    which: PointerButton,
    during: impl FnOnce(&State),
) {
    let modifiers = harness.ctx.input(|input| input.modifiers);
    harness.event(Event::PointerMoved(from));
    harness.step();
    button(harness, from, which, true, modifiers);
    harness.step();
    for step in 1..=8 {
        harness.event(Event::PointerMoved(from + by * (step as f32 / 8.0)));
        harness.step();
    }
    during(harness.state());
    button(harness, from + by, which, false, modifiers);
    harness.step();
}

fn drag(harness: &mut Harness<'_, State>, from: Pos2, by: Vec2) {
    drag_with(harness, from, by, PointerButton::Primary, |_| ());
}

fn wheel(harness: &mut Harness<'_, State>, at: Pos2, lines: f32, modifiers: Modifiers) {
    harness.event(Event::PointerMoved(at));
    harness.step();
    let delta = vec2(0.0, lines);
    let (unit, phase) = (MouseWheelUnit::Line, TouchPhase::Move);
    harness.event(Event::MouseWheel { unit, delta, phase, modifiers });
    harness.run_steps(40);
}

const MIDDLE: Pos2 = pos2(148.0, 98.0);

#[test]
fn the_size_of_the_picture_is_that_of_the_window_in_pixels() {
    let mut harness = harness();
    assert_eq!(harness.state().model.of(Side::B).size, Size { width: 320, height: 200 });
    // The window keeps its pixels, and the margin its points.
    harness.set_pixels_per_point(1.5);
    harness.step();
    harness.step();
    assert_eq!(harness.state().model.of(Side::A).size, Size { width: 312, height: 192 });
    harness.state_mut().model.resolution = Resolution::Window(0.5);
    harness.step();
    assert_eq!(harness.state().model.of(Side::A).size, Size { width: 156, height: 96 });
    let fixed = Size { width: 99, height: 77 };
    harness.state_mut().model.resolution = Resolution::Fixed(fixed);
    harness.step();
    assert_eq!(harness.state().model.of(Side::A).size, fixed);
}

#[test]
fn any_window_gives_a_size_that_can_be_rendered() {
    for room in [vec2(0.0, 0.0), vec2(1.0, 9.0), vec2(1e5, 1e5), vec2(40_000.0, 3.0)] {
        for factor in [0.001, 1.0, 8.0] {
            let size = picture_size(Resolution::Window(factor), room);
            let errors = Settings { size, ..Settings::default() }.validate();
            assert!(errors.is_empty(), "{size:?}: {errors:?}");
        }
    }
}

#[test]
fn nothing_moves_by_itself() {
    let mut harness = harness();
    let before = harness.state().model.settings.clone();
    harness.event(Event::PointerMoved(MIDDLE));
    harness.run_steps(5);
    assert_eq!(harness.state().model.settings, before);
    assert!(!harness.state().model.is_moving);
}

#[test]
fn dragging_turns_the_camera_of_both_sides_around_its_target() {
    let mut harness = harness();
    let before = harness.state().viewpoint();
    drag_with(&mut harness, MIDDLE, vec2(40.0, 10.0), PointerButton::Primary, |state| {
        assert!(state.model.is_moving);
    });
    let state = harness.state();
    let after = state.viewpoint();
    assert_eq!(after.target, before.target);
    assert!(after.position.distance(before.position) > 0.05 * before.distance());
    assert!((after.distance() / before.distance() - 1.0).abs() < 1e-4);
    assert!((after.position - before.position).dot(before.right()) < 0.0, "the scene follows the hand");
    assert_eq!(state.model.of(Side::A).camera_position, state.model.of(Side::B).camera_position);
    assert!(state.model.of(Side::A).validate().is_empty());
    assert!(!state.model.is_moving);
}

#[test]
fn the_middle_button_and_shift_move_across_the_picture() {
    for which in [PointerButton::Middle, PointerButton::Primary] {
        let mut harness = harness();
        let before = harness.state().viewpoint();
        if which == PointerButton::Primary {
            hold(&mut harness, Modifiers::SHIFT);
        }
        drag_with(&mut harness, MIDDLE, vec2(30.0, 0.0), which, |_| ());
        let after = harness.state().viewpoint();
        assert!(after.forward().distance(before.forward()) < 1e-5, "{which:?}");
        assert!((after.target - before.target).dot(before.right()) < 0.0, "{which:?}");
    }
}

#[test]
fn the_wheel_comes_closer() {
    let mut harness = harness();
    let before = harness.state().viewpoint();
    wheel(&mut harness, MIDDLE, 2.0, Modifiers::NONE);
    let after = harness.state().viewpoint();
    assert!((after.distance() / before.distance() - 0.88f32.powi(2)).abs() < 1e-3);
    assert!(!harness.state().model.is_moving);
}

#[test]
fn ctrl_and_wheel_magnify_pixels_and_leave_the_camera() {
    let mut harness = harness();
    let before = harness.state().model.settings.clone();
    hold(&mut harness, Modifiers::COMMAND | Modifiers::CTRL);
    wheel(&mut harness, MIDDLE, 5.0, Modifiers::COMMAND | Modifiers::CTRL);
    assert!(harness.state().canvas.zoom.factor() > 1.5);
    assert_eq!(harness.state().model.settings, before);
    hold(&mut harness, Modifiers::NONE);
    harness.key_press(Key::Num0);
    harness.step();
    assert!(harness.state().canvas.zoom.is_whole());
}

#[test]
fn a_double_click_goes_to_what_is_under_the_cursor() {
    let mut harness = harness();
    let seen = point_at(
        &harness.state().model,
        &harness.state().shown,
        &Placement::new(CANVAS, 1.0, harness.state().model.of(Side::A).size, Fit::Fill, &Zoom::default()),
        MIDDLE,
    )
    .expect("the atrium is everywhere");
    let before = harness.state().viewpoint();
    harness.event(Event::PointerMoved(MIDDLE));
    harness.step();
    for pressed in [true, false, true, false] {
        button(&harness, MIDDLE, PointerButton::Primary, pressed, Modifiers::NONE);
        harness.step();
    }
    assert!(harness.state().model.is_moving, "it is on its way");
    harness.run_steps(20);
    let after = harness.state().viewpoint();
    assert_eq!(after.target, seen);
    assert!(after.position.distance(seen) < before.position.distance(seen));
    assert!(!harness.state().model.is_moving);
}

#[test]
fn the_right_button_looks_and_keys_fly() {
    let mut harness = harness();
    let before = harness.state().viewpoint();
    drag_with(&mut harness, MIDDLE, vec2(30.0, 0.0), PointerButton::Secondary, |_| ());
    let looked = harness.state().viewpoint();
    assert!(looked.position.distance(before.position) < 1e-6);
    assert!(looked.forward().dot(before.right()) > 0.1);

    harness.event(Event::PointerMoved(MIDDLE));
    harness.step();
    button(&harness, MIDDLE, PointerButton::Secondary, true, Modifiers::NONE);
    harness.key_down(Key::W);
    harness.run_steps(30);
    assert!(harness.state().model.is_moving);
    harness.key_up(Key::W);
    button(&harness, MIDDLE, PointerButton::Secondary, false, Modifiers::NONE);
    harness.run_steps(3);
    let flown = harness.state().viewpoint();
    assert!((flown.position - looked.position).normalize().dot(looked.forward()) > 0.99);
    assert!(!harness.state().model.is_moving);
}

#[test]
fn keys_frame_the_scene_and_change_the_projection() {
    let mut harness = harness();
    harness.key_press(Key::F);
    harness.run_steps(20);
    let (low, high) = harness.state().shown.opened.as_ref().expect("open").bounds;
    assert_eq!(harness.state().viewpoint().target, 0.5 * (low + high));

    harness.key_press(Key::O);
    harness.run_steps(20);
    let parallel = harness.state().viewpoint();
    assert!(matches!(parallel.lens, Lens::Orthographic(_)));
    assert!(harness.state().model.of(Side::A).validate().is_empty());
    harness.key_press(Key::Y);
    harness.run_steps(20);
    assert!(harness.state().viewpoint().forward().y < -0.999);
    harness.key_press(Key::O);
    harness.run_steps(20);
    let perspective = harness.state().viewpoint();
    assert!((perspective.height() / parallel.height() - 1.0).abs() < 1e-3);
}

#[test]
fn the_divider_follows_the_hand_and_the_camera_stays() {
    let mut harness = harness();
    harness.state_mut().model.comparison = Comparison::Split;
    harness.step();
    let before = harness.state().model.settings.clone();
    drag(&mut harness, pos2(169.0, 60.0), vec2(-81.0, 30.0));
    let divider = harness.state().model.divider;
    assert!((divider - 0.25).abs() < 0.02, "{divider}");
    assert_eq!(harness.state().model.settings, before);

    harness.key_press(Key::ArrowRight);
    harness.step();
    assert!((harness.state().model.divider - divider - 0.01).abs() < 1e-5);
    drag(&mut harness, pos2(8.0 + 320.0 * (divider + 0.01), 60.0), vec2(-900.0, 0.0));
    assert_eq!(harness.state().model.divider, 0.0, "it stays in the window");
}

#[test]
fn what_others_say_of_movement_is_left_alone() {
    let mut harness = harness();
    harness.state_mut().model.is_moving = true;
    harness.run_steps(3);
    assert!(harness.state().model.is_moving);
}

#[test]
fn the_target_of_an_automatic_camera_is_what_is_in_the_middle() {
    let harness = harness();
    let state = harness.state();
    let rendered = state.shown.sides[0].as_ref().expect("rendered");
    let depth = frame_of(rendered).expect("on the host").gbuffer[100 * 320 + 160].depth;
    assert!((state.viewpoint().distance() / depth - 1.0).abs() < 1e-4);
}

#[test]
fn another_camera_of_the_file_is_waited_for() {
    let mut harness = harness();
    harness.state_mut().model.of_mut(Side::A).camera = ambray::settings::Auto::Value("1".to_owned());
    assert_eq!(viewpoint(&harness.state().model, &harness.state().shown), None);
}

#[test]
fn the_inspector_shows_values_under_the_cursor() {
    let mut harness = harness();
    // Room beside the inspector's window.
    harness.set_size(vec2(900.0, 520.0));
    harness.key_press(Key::I);
    harness.event(Event::PointerMoved(pos2(800.0, 30.0)));
    harness.run_steps(3);
    assert!(harness.state().model.is_inspecting);
    assert!(harness.query_by_label_contains("pixel 286, 8 of").is_some());
    assert!(harness.query_by_label("near-radiance-raw").is_some());
    harness.key_press(Key::I);
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("pixel 286, 8 of").is_none());
}

#[test]
fn a_pinned_pixel_stays_and_tells_what_it_did() {
    let mut harness = harness();
    hold(&mut harness, Modifiers::ALT);
    let place = pos2(310.0, 30.0);
    harness.event(Event::PointerMoved(place));
    harness.step();
    for pressed in [true, false] {
        button(&harness, place, PointerButton::Primary, pressed, Modifiers::ALT);
        harness.step();
    }
    hold(&mut harness, Modifiers::NONE);
    harness.event(Event::PointerMoved(pos2(300.0, 150.0)));
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("pixel 302, 22 of").is_some(), "it is kept");
    assert!(harness.query_by_label_contains("Waiting").is_some());

    let state = harness.state_mut();
    let frame = frame_of(state.shown.sides[0].as_ref().expect("rendered")).expect("on the host").clone();
    let settings = state.model.of(Side::A);
    let inspected = state.renderer.inspect(settings, &frame, (302, 22), Control::default());
    state.shown.inspected = Some(Arc::new(Inspected {
        side: Side::A,
        pixel: (302, 22),
        inspection: inspected.expect("is in the picture"),
    }));
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("rays of all types, sample class").is_some());
    assert!(harness.query_by_label_contains("Filter taps: ").is_some());
    assert!(harness.query_by_label_contains("Rays (1)").is_some());

    harness.key_press(Key::Escape);
    harness.run_steps(2);
    assert!(harness.query_by_label_contains("Filter taps: ").is_none());
}

#[test]
fn the_inspector_says_where_a_pixel_has_no_rays_and_asks_for_none() {
    use ambray::settings::Method;
    let mut harness = harness();
    let state = harness.state_mut();
    let settings = Settings { method: Method::Gtao, ..state.model.of(Side::A).clone() };
    let frame = state.renderer.render(&settings, Control::default()).expect("renders");
    *state.model.of_mut(Side::A) = settings.clone();
    state.shown.sides[0] = Some(rendered(Side::A, &settings, &frame));
    let place = pos2(310.0, 30.0);
    hold(&mut harness, Modifiers::ALT);
    harness.event(Event::PointerMoved(place));
    harness.step();
    for pressed in [true, false] {
        button(&harness, place, PointerButton::Primary, pressed, Modifiers::ALT);
        harness.step();
    }
    hold(&mut harness, Modifiers::NONE);
    harness.run_steps(3);
    assert!(harness.query_by_label_contains("pixel 302, 22 of").is_some(), "its values are shown");
    assert!(harness.query_by_label_contains("gtao works on whole pictures").is_some());
    assert!(harness.query_by_label_contains("Waiting").is_none());
    assert!(harness.get_by_label("Hits").accesskit_node().is_disabled());
    assert_eq!(harness.state().canvas.inspector.asked(), None);
}

#[test]
fn what_a_pixel_did_is_drawn_on_the_picture() {
    let mut harness = harness();
    let lines = |harness: &Harness<'_, State>| {
        let shapes = harness.output().shapes.iter();
        shapes.filter(|clipped| matches!(clipped.shape, egui::Shape::LineSegment { .. })).count()
    };
    let state = harness.state_mut();
    let settings =
        Settings { spp: 64, thin: ambray::settings::Thin::Sheet, ..state.model.of(Side::A).clone() };
    let frame = state.renderer.render(&settings, Control::default()).expect("renders");
    let pixel = (160, 100);
    let inspection = state.renderer.inspect(&settings, &frame, pixel, Control::default()).expect("is there");
    assert!(inspection.rays.len() == 64 && !inspection.chords.is_empty());
    for side in Side::ALL {
        *state.model.of_mut(side) = settings.clone();
        state.shown.sides[side as usize] = Some(rendered(side, &settings, &frame));
    }
    harness.step();
    let before = lines(&harness);
    let place = CANVAS.min + vec2(160.5, 100.5);
    hold(&mut harness, Modifiers::ALT);
    harness.event(Event::PointerMoved(place));
    harness.step();
    for pressed in [true, false] {
        button(&harness, place, PointerButton::Primary, pressed, Modifiers::ALT);
        harness.step();
    }
    hold(&mut harness, Modifiers::NONE);
    harness.state_mut().shown.inspected =
        Some(Arc::new(Inspected { side: Side::A, pixel, inspection: inspection.clone() }));
    harness.run_steps(2);
    let drawn = lines(&harness) - before;
    assert!(drawn > 64, "{drawn} lines of 64 rays with chords");
}
