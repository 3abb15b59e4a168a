//! What must not change a bit of a frame: memory of earlier frames, and the instruction set.

use ambray::{
    Aov, BuildOptions, Control, Frame, Isa, Renderer,
    scene::{Scene, atrium::atrium},
    settings::{
        Auto, Method, NearRadiance, RadianceSource, Rgb, Settings, Size, Temporal, Thin, ThinMinimum, Triple,
        Window,
    },
};

/// Neither side is a multiple of a tile's.
const SIZE: Size = Size { width: 75, height: 45 };

/// From afar: a part of the picture sees no surface.
fn settings() -> Settings {
    Settings {
        size: SIZE,
        spp: 4,
        camera_position: Auto::Value(Triple([0.0, 8.0, 28.0])),
        camera_target: Auto::Value(Triple([0.0, 6.0, 0.0])),
        ..Settings::default()
    }
}

fn rendered(renderer: &mut Renderer, settings: &Settings) -> Frame {
    renderer.render(settings, Control::default()).unwrap()
}

/// All planes, history and unnormalised bent normals included.
#[track_caller]
fn assert_same(frame: &Frame, expected: &Frame, what: &str) {
    assert_eq!((frame.width, frame.height), (expected.width, expected.height), "{what}");
    for &aov in Aov::ALL {
        let bits = |frame: &Frame| frame.plane(aov).into_iter().map(f32::to_bits).collect::<Vec<_>>();
        assert!(bits(frame) == bits(expected), "{what}: {aov} differs");
    }
    let bent = |frame: &Frame| frame.bent.iter().map(|v| v.to_array().map(f32::to_bits)).collect::<Vec<_>>();
    assert!(bent(frame) == bent(expected), "{what}: bent directions differ");
    assert_eq!(frame.stats.rays, expected.stats.rays, "{what}");
}

#[test]
fn frames_given_back_leave_no_trace() {
    let away = Auto::Value(Triple([0.0, 90.0, 60.0]));
    let all = [
        ("plain", settings()),
        ("background", Settings { background: Auto::Value(Rgb([3.0, 0.25, 7.0])), ..settings() }),
        ("nothing seen", Settings { camera_target: away, ..settings() }),
        ("no lights", Settings { lights: false, filter: Window::Off, ..settings() }),
        (
            "sheet, before the filter",
            Settings { thin: Thin::Sheet, near_radiance: NearRadiance::PerHit, ..settings() },
        ),
        (
            "sheet, after the filter",
            Settings {
                thin: Thin::Sheet,
                thin_minimum: ThinMinimum::AfterFilter,
                radiance_source: RadianceSource::SelfSimilar,
                ..settings()
            },
        ),
        ("temporal", Settings { temporal: Temporal::On, ..settings() }),
        ("gtao", Settings { method: Method::Gtao, ..settings() }),
        ("hybrid", Settings { method: Method::Hybrid, ..settings() }),
    ];
    let fresh = |settings| rendered(&mut Renderer::new(atrium()), settings);
    let expected: Vec<Frame> = all.iter().map(|(_, settings)| fresh(settings)).collect();
    let seen = |frame: &Frame| frame.gbuffer.iter().filter(|pixel| pixel.is_surface()).count();
    let pixels = expected[0].gbuffer.len();
    assert!((pixels / 10..pixels * 9 / 10).contains(&seen(&expected[0])), "{} seen", seen(&expected[0]));
    assert_eq!(seen(&expected[2]), 0);

    let mut renderer = Renderer::new(atrium());
    for (first, before) in &all {
        for ((then, after), expected) in all.iter().zip(&expected) {
            renderer.forget_frames();
            let frame = rendered(&mut renderer, before);
            renderer.recycle(frame);
            renderer.forget_frames();
            let frame = rendered(&mut renderer, after);
            assert_same(&frame, expected, &format!("{then} after {first}"));
            renderer.recycle(frame);
        }
    }
    // Of another size.
    let other = Settings { size: Size { width: 45, height: 75 }, ..settings() };
    let expected = fresh(&other);
    assert_same(&rendered(&mut renderer, &other), &expected, "turned");
}

#[test]
fn every_instruction_set_renders_the_same_frame() {
    let on = |isa, scene: Scene| {
        Renderer::on_cpu(scene, BuildOptions { isa: Some(isa), ..BuildOptions::default() })
    };
    let mut renderers: Vec<_> =
        Isa::ALL.into_iter().filter(|isa| isa.is_available()).map(|isa| (isa, on(isa, atrium()))).collect();
    for thin in [Thin::Off, Thin::Sheet] {
        for thin_minimum in [ThinMinimum::BeforeFilter, ThinMinimum::AfterFilter] {
            let settings = Settings { size: SIZE, thin, thin_minimum, ..Settings::default() };
            let mut expected = None;
            for (isa, renderer) in &mut renderers {
                let frame = rendered(renderer, &settings);
                let what = format!("{}, thin {thin}, {thin_minimum}", isa.name());
                assert_same(&frame, expected.get_or_insert_with(|| frame.clone()), &what);
            }
        }
    }
}
