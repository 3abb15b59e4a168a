//! Light that accumulates, and animations that play.

use ambray::{
    Control,
    settings::{Auto, Settings, Temporal, Thin},
};
use ambray_view::{
    engine::{Event, Order},
    model::{Comparison, Side},
};

use crate::common::{Desk, assert_exact, assert_same, host, order, pair, renderer, settings};

/// The last of `frames` frames as `ambray render --temporal on --frames` makes them.
fn sequence(settings: &Settings, frames: u32) -> ambray::Frame {
    let mut renderer = renderer("atrium");
    let render = |i: u32| {
        let frame = settings.frame + i;
        renderer.render(&Settings { frame, ..settings.clone() }, Control::default()).expect("a picture")
    };
    (0..frames).map(render).last().expect("at least one frame")
}

#[test]
fn a_still_view_accumulates_the_frames_of_the_sequence() {
    let mut desk = Desk::with("atrium");
    let wanted = Settings { temporal: Temporal::On, frame: 3, ..settings(48, 27) };
    desk.engine.show(order(&wanted));
    let rendered = desk.picture(Side::A, |picture| picture.frames >= 12);
    assert!(rendered.level.is_final);
    assert_eq!(rendered.settings, Settings { frame: 3 + rendered.frames - 1, ..wanted.clone() });
    assert_same(host(&rendered).0, &sequence(&wanted, rendered.frames));

    // How it is shown does not begin it again; another radius does.
    let brighter = Settings { exposure: 1.0, ..wanted.clone() };
    desk.engine.show(order(&brighter));
    let shown = desk.picture(Side::A, |picture| picture.settings.exposure == 1.0);
    assert!(shown.frames >= rendered.frames);
    let other = Settings { radius: Auto::Value(0.5), ..wanted };
    desk.engine.show(order(&other));
    let first =
        desk.picture(Side::A, |picture| picture.settings.radius == other.radius && picture.level.is_final);
    assert_same(host(&first).0, &sequence(&other, first.frames));
    let last = desk.picture(Side::A, |picture| picture.frames == 256);
    assert_same(host(&last).0, &sequence(&other, 256));
}

#[test]
fn sides_accumulate_as_if_they_were_alone() {
    let mut desk = Desk::with("atrium");
    let a = Settings { temporal: Temporal::On, ..settings(24, 14) };
    let b = Settings { thin: Thin::Sheet, ..a.clone() };
    desk.engine.show(pair(&a, &b, Comparison::Split));
    for _ in 0..2 {
        // Either side may be first.
        let rendered = desk.until("256 frames", |event| match event {
            Event::Picture(picture) if picture.frames == 256 => Some((**picture).clone()),
            _ => None,
        });
        let settings = if rendered.side == Side::A { &a } else { &b };
        assert_same(host(&rendered).0, &sequence(settings, 256));
    }
    // A change of B takes nothing from A.
    let b = Settings { spp: 4, ..b };
    desk.engine.show(pair(&a, &b, Comparison::Split));
    let rendered = desk.picture(Side::B, |picture| picture.frames >= 5 && picture.settings.spp == 4);
    assert_same(host(&rendered).0, &sequence(&b, rendered.frames));
}

#[test]
fn an_animation_plays_and_the_moment_where_it_stops_is_refined() {
    let mut desk = Desk::with("banner");
    let at = |i: u32| Settings { time: Auto::Value(i as f32 / 24.0), ..settings(96, 54) };
    for i in 0..12 {
        desk.engine.show(Order { is_playing: true, ..order(&at(i)) });
        desk.picture(Side::A, |picture| picture.settings.time == at(i).time);
    }
    desk.engine.show(order(&at(11)));
    let is_there =
        |event: &Event| matches!(event, Event::Picture(p) if p.level.is_final && p.settings == at(11));
    // It may have played at full quality.
    if !desk.events.iter().any(is_there) {
        desk.finished(Side::A, &at(11));
    }
    let last = desk.events.iter().rev().find_map(|event| match event {
        Event::Picture(picture) => Some((**picture).clone()),
        _ => None,
    });
    assert_exact("banner", &last.expect("a picture"));
}

#[test]
fn frames_that_play_count_up_where_light_accumulates() {
    let mut desk = Desk::with("banner");
    let at =
        |i: u32| Settings { time: Auto::Value(i as f32 / 24.0), temporal: Temporal::On, ..settings(32, 18) };
    let mut frames = Vec::new();
    for i in 0..8 {
        desk.engine.show(Order { is_playing: true, ..order(&at(i)) });
        frames.push(desk.picture(Side::A, |picture| picture.settings.time == at(i).time).settings.frame);
    }
    assert_eq!(frames, [0, 1, 2, 3, 4, 5, 6, 7]);
}
