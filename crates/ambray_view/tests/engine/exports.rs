//! Files that the window writes, against those of the program.

use std::{fs, path::Path, sync::atomic::AtomicBool};

use ambray::{
    Aov,
    settings::{Method, Settings, Temporal},
};
use ambray_files::{Plan, atomic::Batch, head::Head};
use ambray_view::{
    engine::{Event, Export},
    model::Side,
};

use crate::common::{Desk, order, render, settings};

/// What `ambray render atrium -o path` writes.
fn program(path: &Path, settings: &Settings, planes: &[Aov]) -> Vec<u8> {
    let plan = Plan::new(Some(path), "ambray", None, planes).expect("a plan");
    let mut batch = Batch::default();
    let frame = render("atrium", settings);
    plan.write(&frame, settings, "atrium", &mut batch, &AtomicBool::new(false)).expect("written");
    batch.commit().expect("written");
    fs::read(path).expect("a file")
}

#[track_caller]
fn written(desk: &mut Desk, export: Export) -> Result<(), String> {
    desk.engine.export(export);
    desk.until("the end of the export", |event| match event {
        Event::Exported { .. } => Some(Ok(())),
        Event::ExportFailed { message, .. } => Some(Err(message.clone())),
        _ => None,
    })
}

#[test]
fn screenshots_are_the_files_of_the_program() {
    let folder = tempfile::tempdir().expect("a folder");
    let (ours, theirs) = (folder.path().join("ours"), folder.path().join("theirs"));
    let mut desk = Desk::with("atrium");
    let wanted = settings(64, 36);
    for shown_before in [false, true] {
        if shown_before {
            desk.engine.show(order(&wanted));
            desk.finished(Side::A, &wanted);
        }
        for (extension, aov) in [("png", Aov::Beauty), ("exr", Aov::Beauty), ("exr", Aov::Depth)] {
            let (path, settings) = (ours.with_extension(extension), wanted.clone());
            assert_eq!(written(&mut desk, Export::Screenshot { path: path.clone(), settings, aov }), Ok(()));
            let expected = program(&theirs.with_extension(extension), &wanted, &[aov]);
            assert!(fs::read(&path).expect("a file") == expected, "{extension} {aov}");
        }
    }
    // The plane that is shown takes the place of the picture.
    let path = ours.with_extension("png");
    let settings = wanted.clone();
    assert_eq!(
        written(&mut desk, Export::Screenshot { path: path.clone(), settings, aov: Aov::Openness }),
        Ok(())
    );
    program(&theirs.with_extension("png"), &wanted, &[Aov::Openness]);
    let expected = fs::read(folder.path().join("theirs.openness.png")).expect("a file");
    assert!(fs::read(&path).expect("a file") == expected);
}

#[test]
fn accumulated_light_is_in_the_screenshot() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("mean.png");
    let mut desk = Desk::with("atrium");
    let wanted = Settings { temporal: Temporal::On, ..settings(24, 14) };
    desk.engine.show(order(&wanted));
    desk.picture(Side::A, |picture| picture.frames == 256);
    let settings = wanted.clone();
    assert_eq!(
        written(&mut desk, Export::Screenshot { path: path.clone(), settings, aov: Aov::Beauty }),
        Ok(())
    );
    let head = Head::read(&path).expect("a file").expect("a picture");
    assert_eq!(head.scene.as_deref(), Some("atrium, accumulated from frame 0"));
    assert!(head.settings.expect("settings").contains("frame = 255"));
}

#[test]
fn a_turn_is_numbered_pictures_or_a_video() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut desk = Desk::with("atrium");
    let wanted = settings(32, 18);
    let turn = |name: &str| Export::Turntable {
        path: folder.path().join(name),
        settings: wanted.clone(),
        aov: Aov::Beauty,
        frames: 4,
        fps: 10.0,
    };
    assert_eq!(written(&mut desk, turn("new/turn_##.png")), Ok(()));
    let first = fs::read(folder.path().join("new/turn_00.png")).expect("a file");
    assert!(first == program(&folder.path().join("first.png"), &wanted, &[]));
    let third = fs::read(folder.path().join("new/turn_03.png")).expect("a file");
    assert!(third != first);
    assert_eq!(written(&mut desk, turn("turn.gif")), Ok(()));
    assert!(fs::read(folder.path().join("turn.gif")).expect("a file").starts_with(b"GIF89a"));
    let message = written(&mut desk, turn("turn.png")).unwrap_err();
    assert!(message.contains("turn_####.png"), "{message}");
}

#[test]
fn an_export_that_is_stopped_leaves_no_file_and_the_view_goes_on() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("long.png");
    let mut desk = Desk::with("atrium");
    let long = Settings { spp: 4096, ..settings(1280, 720) };
    desk.engine.export(Export::Screenshot { path, settings: long, aov: Aov::Beauty });
    desk.until("the export", |event| matches!(event, Event::Exporting { .. }).then_some(()));
    desk.engine.cancel_export();
    let message = desk.until("the end of the export", |event| match event {
        Event::ExportFailed { message, .. } => Some(message.clone()),
        Event::Exported { path } => panic!("{} was written", path.display()),
        _ => None,
    });
    assert_eq!(message, "cancelled");
    assert_eq!(fs::read_dir(folder.path()).expect("the folder").count(), 0);
    let wanted = settings(32, 18);
    desk.engine.show(order(&wanted));
    desk.finished(Side::A, &wanted);
}

#[test]
fn a_pixel_tells_what_it_did() {
    let mut desk = Desk::with("atrium");
    let wanted = settings(64, 36);
    desk.engine.show(order(&wanted));
    desk.finished(Side::A, &wanted);
    desk.engine.inspect(Side::A, (20, 30));
    let inspected = desk.until("the inspection", |event| match event {
        Event::Inspected(inspected) => Some(inspected.clone()),
        _ => None,
    });
    assert_eq!((inspected.pixel, inspected.inspection.pixel), ((20, 30), (20, 30)));
    let frame = render("atrium", &wanted);
    let index = 30 * 64 + 20;
    assert_eq!(inspected.inspection.raw, frame.ambient_raw[index]);
    assert_eq!(inspected.inspection.ray_count(), frame.gbuffer[index].rays as usize);
    desk.engine.inspect(Side::A, (64, 0));
    desk.until("the failure", |event| matches!(event, Event::InspectFailed { .. }).then_some(()));
}

#[test]
fn pixels_without_rays_of_their_own_are_no_errors() {
    let mut desk = Desk::with("atrium");
    let gtao = Settings { method: Method::Gtao, ..settings(64, 36) };
    desk.engine.show(order(&gtao));
    desk.finished(Side::A, &gtao);
    desk.engine.inspect(Side::A, (20, 30));
    let traced = settings(64, 36);
    desk.engine.show(order(&traced));
    desk.finished(Side::A, &traced);
    desk.engine.inspect(Side::A, (20, 30));
    desk.until("the inspection", |event| matches!(event, Event::Inspected(_)).then_some(()));
    assert!(!desk.events.iter().any(|event| matches!(event, Event::InspectFailed { .. })));
}
