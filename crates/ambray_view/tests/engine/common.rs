//! An engine to talk to, and what it is held against.

use std::{
    collections::VecDeque,
    path::Path,
    sync::Arc,
    time::{Duration, Instant},
};

use ambray::{
    Aov, BackendChoice, Control, Frame, Renderer, RendererOptions, display,
    scene::{atrium, moving},
    settings::{Settings, Size},
};
use ambray_view::{
    engine::{Content, Difference, Engine, EngineOptions, Event, Opened, Order, Pixels, Rendered, Wake},
    model::{Comparison, SceneRef, Side},
};

/// Nothing here takes nearly as long; what does is stuck.
const WATCHDOG: Duration = Duration::from_secs(120);

/// An engine, and what it has said.
pub(crate) struct Desk {
    pub(crate) engine: Engine,
    /// What was taken in.
    pub(crate) events: Vec<Event>,
    /// What has come and was not taken in yet.
    ahead: VecDeque<Event>,
}

impl Desk {
    pub(crate) fn new() -> Self {
        Self::of(RendererOptions { backend: BackendChoice::Cpu, ..RendererOptions::default() }, false)
    }

    /// With an engine of `renderer`.
    pub(crate) fn of(renderer: RendererOptions, keeps_on_device: bool) -> Self {
        let wake = Wake(Arc::new(|| ()));
        let engine = Engine::new(EngineOptions { renderer, threads: 0, keeps_on_device, wake });
        Self { engine, events: Vec::new(), ahead: VecDeque::new() }
    }

    /// With `scene` open.
    pub(crate) fn with(scene: impl AsRef<Path>) -> Self {
        let mut desk = Self::new();
        desk.engine.open(&SceneRef::new(scene.as_ref()));
        desk.opened();
        desk
    }

    /// Takes events until `find` finds one.
    #[track_caller]
    pub(crate) fn until<T>(&mut self, what: &str, find: impl Fn(&Event) -> Option<T>) -> T {
        let start = Instant::now();
        loop {
            self.ahead.extend(self.engine.poll());
            while let Some(event) = self.ahead.pop_front() {
                let found = find(&event);
                self.events.push(event);
                if let Some(found) = found {
                    return found;
                }
            }
            assert!(
                start.elapsed() < WATCHDOG,
                "{what} never came; last: {:?}",
                self.events.last().map(name)
            );
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[track_caller]
    pub(crate) fn opened(&mut self) -> Arc<Opened> {
        self.until("the scene", |event| match event {
            Event::Opened(opened) => Some(Arc::clone(opened)),
            Event::OpenFailed { message, .. } => panic!("{message}"),
            _ => None,
        })
    }

    /// The next picture of `side` that `fits`.
    #[track_caller]
    pub(crate) fn picture(&mut self, side: Side, fits: impl Fn(&Rendered) -> bool) -> Rendered {
        self.until("the picture", |event| match event {
            Event::Picture(picture) if picture.side == side && fits(picture) => Some((**picture).clone()),
            Event::Refused { messages, .. } => panic!("{messages:?}"),
            _ => None,
        })
    }

    /// The next final picture of `side` with `settings`.
    #[track_caller]
    pub(crate) fn finished(&mut self, side: Side, settings: &Settings) -> Rendered {
        self.picture(side, |picture| picture.level.is_final && picture.settings == *settings)
    }

    #[track_caller]
    pub(crate) fn difference(&mut self) -> Difference {
        self.until("the difference", |event| match event {
            Event::Difference(difference) => Some((**difference).clone()),
            _ => None,
        })
    }
}

fn name(event: &Event) -> String {
    format!("{event:?}").chars().take(80).collect()
}

pub(crate) fn settings(width: u32, height: u32) -> Settings {
    Settings { size: Size { width, height }, ..Settings::default() }
}

/// An order of side A alone.
pub(crate) fn order(settings: &Settings) -> Order {
    Order {
        sides: [Some(settings.clone()), None],
        aov: Aov::Beauty,
        comparison: Comparison::Off,
        is_moving: false,
        is_playing: false,
    }
}

pub(crate) fn pair(a: &Settings, b: &Settings, comparison: Comparison) -> Order {
    Order { sides: [Some(a.clone()), Some(b.clone())], comparison, ..order(a) }
}

/// The library's own renderer of the same scene.
pub(crate) fn renderer(scene: &str) -> Renderer {
    Renderer::new(if scene == "banner" { moving::banner() } else { atrium::atrium() })
}

pub(crate) fn render(scene: &str, settings: &Settings) -> Frame {
    renderer(scene).render(settings, Control::default()).expect("a picture")
}

#[track_caller]
pub(crate) fn host(rendered: &Rendered) -> (&Frame, &Pixels) {
    match &rendered.content {
        Content::Host { frame, pixels } => (frame, pixels),
        Content::Device { .. } => panic!("the processor has no device"),
    }
}

/// Both frames have the same planes, bit for bit.
#[track_caller]
pub(crate) fn assert_same(actual: &Frame, expected: &Frame) {
    assert_eq!((actual.width, actual.height), (expected.width, expected.height));
    for &aov in Aov::ALL {
        let bits = |frame: &Frame| frame.plane(aov).into_iter().map(f32::to_bits).collect::<Vec<_>>();
        assert!(bits(actual) == bits(expected), "{aov} differs");
    }
}

/// `rendered` is what the library makes of its settings, and shows the bytes of the file.
#[track_caller]
pub(crate) fn assert_exact(scene: &str, rendered: &Rendered) {
    let expected = render(scene, &rendered.settings);
    let (frame, pixels) = host(rendered);
    assert_same(frame, &expected);
    assert!(pixels.rgba == display::show(&expected, rendered.aov, &rendered.settings).rgba8());
}
