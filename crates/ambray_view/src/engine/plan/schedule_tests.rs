//! What is rendered after what, without rendering.

use ambray::{
    Aov,
    settings::{Auto, Method, Settings, Size, Temporal},
};

use super::*;
use crate::model::Comparison;

fn settings(spp: u32) -> Settings {
    Settings { size: Size { width: 640, height: 360 }, spp, ..Settings::default() }
}

fn order(a: &Settings, b: Option<&Settings>) -> Order {
    let comparison = if b.is_some() { Comparison::Split } else { Comparison::Off };
    Order {
        sides: [Some(a.clone()), b.cloned()],
        aov: Aov::Beauty,
        comparison,
        is_moving: false,
        is_playing: false,
    }
}

/// Takes the next step, as if it took no time that could be measured.
fn step(schedule: &mut Schedule) -> Option<Step> {
    let step = schedule.next()?;
    schedule.begin();
    schedule.done(&step, 0.0);
    Some(step)
}

fn names(schedule: &mut Schedule, most: usize) -> Vec<(Side, f32, u32)> {
    let steps = std::iter::from_fn(|| step(schedule)).take(most);
    steps.map(|step| (step.side, step.level.scale, step.level.spp)).collect()
}

#[test]
fn sides_take_turns_from_coarse_to_fine() {
    let mut schedule = Schedule::default();
    schedule.take(&order(&settings(8), Some(&settings(4))));
    let steps = names(&mut schedule, 20);
    let sides: Vec<Side> = steps.iter().map(|step| step.0).collect();
    assert_eq!(sides, [Side::A, Side::B].repeat(4));
    assert!(steps.is_sorted_by(|a, b| a.1 <= b.1), "{steps:?}");
    assert_eq!(schedule.next(), None);
}

#[test]
fn only_what_has_changed_is_rendered_again() {
    let mut schedule = Schedule::default();
    schedule.take(&order(&settings(8), Some(&settings(4))));
    names(&mut schedule, 20);
    schedule.take(&order(&Settings { exposure: 2.0, ..settings(8) }, Some(&settings(4))));
    assert_eq!(schedule.next(), None);
    schedule.take(&order(&settings(8), Some(&settings(2))));
    assert!(names(&mut schedule, 20).iter().all(|step| step.0 == Side::B));
    // A side that is hidden for a while is still there.
    schedule.take(&order(&settings(8), None));
    schedule.take(&order(&settings(8), Some(&settings(2))));
    assert_eq!(schedule.next(), None);
    schedule.clear(false);
    assert_eq!(names(&mut schedule, 20).len(), 8);
}

#[test]
fn what_moves_is_shown_once_and_refined_when_it_stops() {
    let mut schedule = Schedule::default();
    for seed in 0..3 {
        let moving = Settings { seed, ..settings(8) };
        schedule.take(&Order { is_moving: true, ..order(&moving, None) });
        let first = step(&mut schedule).expect("a picture");
        assert!(first.is_first && !first.level.is_final);
        assert_eq!(schedule.next(), None);
    }
    schedule.take(&order(&Settings { seed: 2, ..settings(8) }, None));
    let scales: Vec<f32> = names(&mut schedule, 20).iter().map(|step| step.1).collect();
    assert_eq!(scales, [0.25, 0.5, 1.0]);
}

#[test]
fn what_is_refused_is_not_tried_again() {
    let mut schedule = Schedule::default();
    schedule.take(&order(&settings(8), Some(&settings(4))));
    let refused = schedule.next().expect("a step");
    schedule.refuse(&refused);
    assert!(names(&mut schedule, 20).iter().all(|step| step.0 == Side::B));
    schedule.take(&order(&settings(2), Some(&settings(4))));
    assert_eq!(step(&mut schedule).map(|step| step.side), Some(Side::A));
}

#[test]
fn accumulation_begins_once_and_counts_up_to_its_end() {
    let mut schedule = Schedule::default();
    schedule.take(&order(&Settings { temporal: Temporal::On, frame: 5, ..settings(8) }, None));
    let steps: Vec<Step> = std::iter::from_fn(|| step(&mut schedule)).take(1000).collect();
    let frames: Vec<_> = steps.iter().filter(|step| step.settings.temporal == Temporal::On).collect();
    assert_eq!(frames.len(), 256);
    for (i, step) in frames.iter().enumerate() {
        assert_eq!((step.settings.frame, step.frames), (5 + i as u32, 1 + i as u32));
        assert_eq!((step.begins, step.is_shown, step.level.is_final), (i == 0, true, true));
    }
}

#[test]
fn frames_that_were_lost_are_caught_up_with_unseen() {
    let mut schedule = Schedule::default();
    let (a, b) = (Settings { temporal: Temporal::On, ..settings(8) }, settings(8));
    schedule.take(&order(&a, Some(&b)));
    // The final level of B takes the place of A's, so nine frames begin anew.
    names(&mut schedule, 8 + 9);
    schedule.take(&order(&a, Some(&settings(4))));
    names(&mut schedule, 4);
    let again: Vec<_> = std::iter::from_fn(|| step(&mut schedule)).take(12).collect();
    let seen: Vec<_> = again.iter().map(|step| (step.settings.frame, step.begins, step.is_shown)).collect();
    let expected: Vec<_> = (0..12).map(|i| (i, i == 0, i >= 9)).collect();
    assert_eq!(seen, expected);
}

#[test]
fn each_moment_that_plays_is_shown_once() {
    let mut schedule = Schedule::default();
    for i in 0..5 {
        let moment = Settings { time: Auto::Value(i as f32), temporal: Temporal::On, ..settings(8) };
        schedule.take(&Order { is_playing: true, ..order(&moment, None) });
        let step = step(&mut schedule).expect("a picture");
        assert_eq!((step.settings.frame, step.frames, step.begins), (i, i + 1, i == 0));
        assert_eq!(schedule.next(), None);
    }
}

#[test]
fn a_picture_that_is_lost_is_made_again_unless_it_is_under_way() {
    let mut schedule = Schedule::default();
    schedule.take(&order(&settings(8), Some(&settings(4))));
    // Nothing is done yet that could be lost.
    schedule.again(Side::A);
    assert_eq!(names(&mut schedule, 20).len(), 8);
    schedule.again(Side::A);
    let steps = names(&mut schedule, 20);
    assert!(!steps.is_empty() && steps.iter().all(|step| step.0 == Side::A), "{steps:?}");
}

#[test]
fn methods_without_rays_are_refined_in_size_alone() {
    for method in [Method::Ssao, Method::Hbao, Method::Gtao, Method::Bitmask] {
        let mut schedule = Schedule::default();
        let asked = Settings { method, ..settings(1024) };
        schedule.take(&order(&asked, None));
        let steps: Vec<Step> = std::iter::from_fn(|| step(&mut schedule)).take(20).collect();
        let sizes: Vec<u32> = steps.iter().map(|step| step.settings.size.width).collect();
        assert_eq!(sizes, [80, 160, 320, 640], "{method}");
        // The last one is what was asked for, to the letter; none is a picture that was there before.
        assert_eq!(steps.last().map(|step| &step.settings), Some(&asked));
        assert!(steps.iter().all(|step| step.settings.spp == 1024 && step.level.spp == 0));
    }
    // Where the depth buffer cannot know, rays are taken: their number counts.
    let mut schedule = Schedule::default();
    schedule.take(&order(&Settings { method: Method::Hybrid, ..settings(64) }, None));
    let spp: Vec<u32> = names(&mut schedule, 20).iter().map(|step| step.2).collect();
    assert_eq!(spp, [4, 4, 4, 4, 16, 64]);
}

#[test]
fn what_takes_no_rays_does_not_make_rays_look_quick() {
    let mut schedule = Schedule::default();
    schedule.take(&order(&Settings { method: Method::Gtao, ..settings(1024) }, None));
    while let Some(step) = schedule.next() {
        schedule.begin();
        schedule.done(&step, 0.01);
    }
    // If the 0.01 seconds had been those of 1024 rays a pixel, they would seem to fit into the 0.05 of a first picture.
    schedule.take(&order(&settings(1024), None));
    assert!(
        schedule.next().is_some_and(|first| first.level.spp <= 4),
        "the first picture would block the window"
    );
}
