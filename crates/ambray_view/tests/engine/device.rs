//! Pictures that stay on the device that renders them.

use std::{fs, sync::Arc};

use ambray::{
    Aov, BackendChoice, Control, Device, Frame, Machine, Renderer, RendererOptions, display,
    scene::atrium::atrium,
    settings::{Auto, Method, Settings, Temporal, Thin, Triple},
    vulkan::{Context, DeviceOptions, VulkanError, testing::picture_bytes},
};
use ambray_view::{
    engine::{Content, Event, Export, Inspected, Order, Rendered, Statistics},
    model::{Comparison, SceneRef, Side},
};

use crate::common::{Desk, assert_same, order, pair, settings};

/// A device with the validation layer watching; `None`, with a line that says so, where there is none.
fn device() -> Option<Device> {
    let software = std::env::var_os("AMBRAY_VULKAN").is_none_or(|value| value != "hardware");
    match Context::new(&DeviceOptions { device: None, software, validation: true }) {
        Ok(context) => Some(Device::of(context)),
        Err(error) => {
            let is_absent = matches!(
                error,
                VulkanError::NoLoader { .. }
                    | VulkanError::NoDriver
                    | VulkanError::NoDevice { .. }
                    | VulkanError::Missing { .. }
            );
            let is_required = std::env::var_os("AMBRAY_REQUIRE_VULKAN").is_some_and(|value| value == "1");
            assert!(is_absent && !is_required, "{error}");
            eprintln!("skipped: {error}");
            None
        }
    }
}

fn options(device: &Device) -> RendererOptions {
    let shared = Some(device.clone());
    RendererOptions { backend: BackendChoice::Vulkan, shared, ..RendererOptions::default() }
}

/// An engine that keeps its pictures on `device`, with the atrium open.
fn desk(device: &Device) -> Desk {
    let mut desk = Desk::of(options(device), true);
    desk.engine.open(&SceneRef::new("atrium"));
    assert!(matches!(desk.opened().machine, Machine::Vulkan { .. }));
    desk
}

/// What the library renders on `device`.
fn render(device: &Device, settings: &Settings) -> Frame {
    let mut renderer = Renderer::open(atrium(), &options(device), Control::default()).expect("the atrium");
    renderer.render(settings, Control::default()).expect("a picture")
}

fn copied(desk: &mut Desk, of: Side, shown: Aov) -> (Arc<Frame>, Arc<Statistics>) {
    desk.until("the copy", |event| match event {
        Event::Copied { side, frame, aov, statistics } if (*side, *aov) == (of, shown) => {
            Some((Arc::clone(frame), Arc::clone(statistics)))
        }
        _ => None,
    })
}

fn inspected(desk: &mut Desk) -> Inspected {
    desk.until("the inspection", |event| match event {
        Event::Inspected(inspected) => Some((**inspected).clone()),
        Event::InspectFailed { message, .. } => panic!("{message}"),
        _ => None,
    })
}

/// The picture on the device shows `frame` as the file would, up to the last bit of a byte.
#[track_caller]
fn assert_shows(device: &Device, rendered: &Rendered, frame: &Frame) {
    let Content::Device { picture, .. } = &rendered.content else { panic!("it has left the device") };
    assert_eq!(picture.size(), (frame.width, frame.height));
    let actual = picture_bytes(device.context(), picture).expect("its bytes");
    let expected = display::show(frame, rendered.aov, &rendered.settings).rgba8();
    assert_eq!(actual.len(), expected.len());
    let largest = actual.iter().zip(&expected).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(largest <= Some(1), "{} differs by {largest:?}", rendered.aov);
}

/// Ends `desk`; nothing was wrong with how it used `device`.
#[track_caller]
fn end(desk: Desk, device: &Device) {
    drop(desk);
    let messages = device.context().validation_messages();
    assert!(messages.is_empty(), "{}", messages.join("\n"));
}

#[test]
fn pictures_stay_there_and_their_planes_follow() {
    let Some(device) = device() else { return };
    let mut desk = desk(&device);
    let wanted = Settings { thin: Thin::Sheet, ..settings(64, 36) };
    desk.engine.show(order(&wanted));
    let rendered = desk.finished(Side::A, &wanted);
    let (frame, statistics) = copied(&mut desk, Side::A, Aov::Beauty);
    assert_same(&frame, &render(&device, &wanted));
    assert_shows(&device, &rendered, &frame);
    assert_eq!(*statistics, Statistics::of(&frame.plane(Aov::Beauty), 3));

    // To be shown in another way it is neither rendered nor copied again.
    for (aov, exposure) in [(Aov::Openness, 0.0), (Aov::Beauty, -1.0), (Aov::Depth, -1.0)] {
        let other = Settings { exposure, ..wanted.clone() };
        desk.engine.show(Order { aov, ..order(&other) });
        let rendered = desk.picture(Side::A, |picture| picture.aov == aov && picture.settings == other);
        assert_shows(&device, &rendered, &frame);
        // After the picture, whose values they are.
        let (same, statistics) = copied(&mut desk, Side::A, aov);
        assert!(Arc::ptr_eq(&same, &frame));
        assert_eq!(*statistics, Statistics::of(&frame.plane(aov), aov.channels().len()));
    }
    end(desk, &device);
}

/// The device keeps one frame, but both are wanted, also after both have followed something that was dragged.
#[test]
fn sides_are_compared() {
    let Some(device) = device() else { return };
    let mut desk = desk(&device);
    let at = |i: u32, spp| Settings {
        camera_position: Auto::Value(Triple([0.1 + 0.1 * i as f32, 1.5, 2.0])),
        camera_target: Auto::Value(Triple([0.0, 1.0, 0.0])),
        spp,
        ..settings(48, 27)
    };
    let both = |i, is_moving| Order {
        is_moving,
        aov: Aov::Openness,
        ..pair(&at(i, 8), &at(i, 2), Comparison::Difference)
    };
    let expect = |desk: &mut Desk, i| {
        let planes = [8, 2].map(|spp| render(&device, &at(i, spp)).plane(Aov::Openness));
        let squares = planes[0].iter().zip(&planes[1]).map(|(a, b)| f64::from(a - b).powi(2));
        let rmse = (squares.sum::<f64>() / planes[0].len() as f64).sqrt();
        desk.until("the difference", |event| match event {
            Event::Difference(found) => ((found.rmse - rmse).abs() < 1e-9).then_some(()),
            _ => None,
        });
    };
    desk.engine.show(both(0, false));
    expect(&mut desk, 0);
    for i in 1..4 {
        desk.engine.show(both(i, true));
        for side in Side::ALL {
            let spp = if side == Side::A { 8 } else { 2 };
            desk.picture(side, |picture| picture.settings.camera_position == at(i, spp).camera_position);
        }
    }
    desk.engine.show(both(3, false));
    expect(&mut desk, 3);
    end(desk, &device);
}

#[test]
fn pixels_tell_what_they_did_while_light_accumulates() {
    let Some(device) = device() else { return };
    let mut desk = desk(&device);
    let still = settings(64, 36);
    desk.engine.show(order(&still));
    // Asked for before the picture is there.
    desk.engine.inspect(Side::A, (20, 30));
    let found = inspected(&mut desk);
    let index = 30 * 64 + 20;
    let frame = render(&device, &still);
    assert_eq!((found.side, found.pixel), (Side::A, (20, 30)));
    assert_eq!(found.inspection.raw, frame.ambient_raw[index]);
    assert_eq!(found.inspection.ray_count(), frame.gbuffer[index].rays as usize);

    let accumulating = Settings { temporal: Temporal::On, ..still };
    desk.engine.show(order(&accumulating));
    for pixel in [(1, 2), (40, 20), (63, 35)] {
        desk.picture(Side::A, |picture| picture.level.is_final && picture.frames > 1);
        desk.engine.inspect(Side::A, pixel);
        assert_eq!(inspected(&mut desk).pixel, pixel);
    }
    end(desk, &device);
}

#[test]
fn an_export_leaves_the_picture_as_it_was() {
    let Some(device) = device() else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let mut desk = desk(&device);
    let wanted = settings(64, 36);
    desk.engine.show(order(&wanted));
    desk.finished(Side::A, &wanted);
    let path = folder.path().join("other.png");
    let other = Settings { spp: 4, ..settings(32, 18) };
    desk.engine.export(Export::Screenshot { path: path.clone(), settings: other, aov: Aov::Beauty });
    desk.until("the file", |event| match event {
        Event::Exported { .. } => Some(()),
        Event::ExportFailed { message, .. } => panic!("{message}"),
        _ => None,
    });
    assert!(fs::read(&path).expect("the file").starts_with(b"\x89PNG"));
    // Its frame is shown by the processor now.
    let darker = Settings { exposure: -2.0, ..wanted.clone() };
    desk.engine.show(order(&darker));
    let rendered = desk.finished(Side::A, &darker);
    let Content::Host { frame, pixels } = &rendered.content else { panic!("the device has another frame") };
    assert_same(frame, &render(&device, &wanted));
    assert!(pixels.rgba == display::show(frame, Aov::Beauty, &darker).rgba8());
    end(desk, &device);
}

#[test]
fn a_busy_engine_is_dropped_and_the_device_is_left_in_order() {
    let Some(device) = device() else { return };
    let desk = desk(&device);
    desk.engine.show(order(&Settings { spp: 1024, ..settings(640, 360) }));
    std::thread::sleep(std::time::Duration::from_millis(200));
    desk.engine.open(&SceneRef::new("flock"));
    end(desk, &device);
    // Others go on with it.
    render(&device, &settings(16, 9));
}

#[test]
fn a_method_of_the_processor_is_rendered_there_and_says_so() {
    let Some(device) = device() else { return };
    // With the device alone, the method would be refused.
    let options = RendererOptions { backend: BackendChoice::Auto, ..options(&device) };
    let mut desk = Desk::of(options, true);
    desk.engine.open(&SceneRef::new("atrium"));
    assert!(matches!(desk.opened().machine, Machine::Vulkan { .. }));
    for method in [Method::Ambray, Method::Gtao, Method::Ambray] {
        let wanted = Settings { method, ..settings(32, 18) };
        desk.engine.show(order(&wanted));
        let rendered = desk.finished(Side::A, &wanted);
        match method {
            Method::Ambray => assert!(matches!(rendered.machine, Machine::Vulkan { .. }), "{rendered:?}"),
            _ => assert!(
                matches!(&rendered.machine, Machine::Cpu { reason: Some(reason), .. } if reason.contains("gtao")),
                "{:?}",
                rendered.machine
            ),
        }
    }
    end(desk, &device);
}
