//! From an order to its picture.

use ambray::{
    Aov,
    settings::{Auto, Settings, Temporal, Thin, Triple},
};
use ambray_view::{
    engine::{Event, Order, Statistics},
    model::{Comparison, Side},
};

use crate::common::{Desk, assert_exact, host, order, pair, render, settings};

#[test]
fn the_last_picture_is_that_of_the_library_bit_for_bit() {
    let mut desk = Desk::with("atrium");
    for (spp, thin) in [(8, Thin::Off), (20, Thin::Sheet)] {
        let wanted = Settings { spp, thin, exposure: 0.5, ..settings(93, 61) };
        desk.engine.show(order(&wanted));
        let rendered = desk.finished(Side::A, &wanted);
        assert_eq!((rendered.level.scale, rendered.level.spp, rendered.frames), (1.0, spp, 1));
        assert!(rendered.frame_bytes > 93 * 61 * 100);
        assert_exact("atrium", &rendered);
    }
}

#[test]
fn coarse_pictures_come_before_fine_ones() {
    let mut desk = Desk::with("atrium");
    let wanted = Settings { spp: 64, ..settings(160, 90) };
    desk.engine.show(order(&wanted));
    let first = desk.picture(Side::A, |_| true);
    assert!(!first.level.is_final, "nothing is known of the scene yet: {:?}", first.level);
    assert_eq!((host(&first).0.width, first.settings.size.width), (20, 20));
    desk.finished(Side::A, &wanted);
    let levels: Vec<_> = desk
        .events
        .iter()
        .filter_map(|event| match event {
            Event::Picture(picture) => Some((picture.level.scale, picture.level.spp)),
            _ => None,
        })
        .collect();
    assert!(levels.is_sorted(), "{levels:?}");
}

#[test]
fn a_storm_of_orders_shows_pictures_and_ends_with_the_right_one() {
    let mut desk = Desk::with("atrium");
    let at = |i: u32| Settings {
        camera_position: Auto::Value(Triple([0.1 + 0.01 * i as f32, 1.5, 2.0])),
        camera_target: Auto::Value(Triple([0.0, 1.0, 0.0])),
        ..settings(320, 180)
    };
    for i in 0..200 {
        desk.engine.show(Order { is_moving: true, ..order(&at(i)) });
        std::thread::sleep(std::time::Duration::from_millis(2));
    }
    desk.engine.show(order(&at(199)));
    let rendered = desk.finished(Side::A, &at(199));
    assert_exact("atrium", &rendered);
    let shown = desk.events.iter().filter(|event| matches!(event, Event::Picture(_))).count();
    assert!(shown >= 3, "only {shown} pictures were shown while dragging");
}

#[test]
fn both_sides_are_refined_and_one_that_did_not_change_is_left_alone() {
    let mut desk = Desk::with("atrium");
    let (a, b) = (settings(64, 36), Settings { thin: Thin::Sheet, ..settings(64, 36) });
    desk.engine.show(pair(&a, &b, Comparison::Split));
    let mut found = Vec::new();
    while found.len() < 2 {
        let rendered = desk.until("both", |event| match event {
            Event::Picture(picture) if picture.level.is_final => Some((**picture).clone()),
            _ => None,
        });
        assert_exact("atrium", &rendered);
        found.push(rendered.side);
    }
    found.sort_by_key(|side| *side as usize);
    assert_eq!(found, Side::ALL);

    let b = Settings { spp: 4, ..b };
    desk.events.clear();
    desk.engine.show(pair(&a, &b, Comparison::Split));
    desk.finished(Side::B, &b);
    let of_a = |event: &&Event| matches!(event, Event::Picture(picture) if picture.side == Side::A);
    assert_eq!(desk.events.iter().filter(of_a).count(), 0);
}

#[test]
fn how_it_is_shown_needs_no_rendering() {
    let mut desk = Desk::with("atrium");
    let wanted = settings(64, 36);
    desk.engine.show(order(&wanted));
    let before = desk.finished(Side::A, &wanted);
    for (aov, exposure) in [(Aov::Beauty, 2.0), (Aov::Depth, 2.0), (Aov::Openness, 0.0)] {
        let other = Settings { exposure, ..wanted.clone() };
        desk.engine.show(Order { aov, ..order(&other) });
        let rendered = desk.picture(Side::A, |picture| picture.aov == aov && picture.settings == other);
        assert!(std::ptr::eq(host(&rendered).0, host(&before).0), "{aov} was rendered again");
        assert_exact("atrium", &rendered);
        let values = host(&before).0.plane(aov);
        let statistics = rendered.statistics.expect("statistics");
        assert_eq!(*statistics, Statistics::of(&values, aov.channels().len()));
    }
}

#[test]
fn settings_that_cannot_be_rendered_are_refused_and_the_engine_goes_on() {
    let mut desk = Desk::with("atrium");
    let bad = Settings { spp: 0, radius: Auto::Value(f32::NAN), ..settings(32, 18) };
    for _ in 0..3 {
        desk.engine.show(order(&bad));
    }
    let messages = desk.until("the refusal", |event| match event {
        Event::Refused { messages, .. } => Some(messages.clone()),
        _ => None,
    });
    assert_eq!(messages.len(), 2, "{messages:?}");
    let unknown = Settings { camera: Auto::Value("nobody's".to_owned()), ..settings(32, 18) };
    desk.engine.show(order(&unknown));
    let messages = desk.until("the refusal", |event| match event {
        Event::Refused { messages, .. } => Some(messages.clone()),
        _ => None,
    });
    assert!(messages[0].contains("nobody's"), "{messages:?}");
    let good = settings(32, 18);
    desk.engine.show(order(&good));
    desk.finished(Side::A, &good);
}

#[test]
fn a_side_does_not_differ_from_itself() {
    let mut desk = Desk::with("atrium");
    let wanted = settings(64, 36);
    desk.engine.show(pair(&wanted, &wanted, Comparison::Difference));
    let difference = desk.difference();
    assert_eq!((difference.rmse, difference.bias, difference.largest), (0.0, 0.0, 0.0));
    assert!(difference.pixels.rgba.chunks(4).all(|pixel| pixel == [0, 0, 0, 255]));
}

#[test]
fn differences_are_those_of_the_planes() {
    let mut desk = Desk::with("atrium");
    let (a, b) = (settings(64, 36), Settings { spp: 4, ..settings(64, 36) });
    desk.engine.show(Order { aov: Aov::Openness, ..pair(&a, &b, Comparison::Difference) });
    // Previews are compared as well: the last one is that of the final pictures.
    let planes = [&a, &b].map(|settings| render("atrium", settings).plane(Aov::Openness));
    let differences: Vec<f64> = planes[0].iter().zip(&planes[1]).map(|(a, b)| f64::from(a - b)).collect();
    let count = differences.len() as f64;
    let rmse = (differences.iter().map(|d| d * d).sum::<f64>() / count).sqrt();
    let bias = differences.iter().sum::<f64>() / count;
    desk.until("the difference", |event| match event {
        Event::Difference(found) => {
            let is_it = (found.rmse - rmse).abs() < 1e-9 && (found.bias - bias).abs() < 1e-9;
            is_it.then_some(())
        }
        _ => None,
    });
}

#[test]
fn dropping_a_busy_engine_returns() {
    let desk = Desk::with("atrium");
    let long = Settings { spp: 4096, temporal: Temporal::On, ..settings(1920, 1080) };
    desk.engine.show(order(&long));
    std::thread::sleep(std::time::Duration::from_millis(300));
    drop(desk);
    let desk = Desk::new();
    desk.engine.open(&ambray_view::model::SceneRef::new("flock"));
    drop(desk);
}
