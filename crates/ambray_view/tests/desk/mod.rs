//! An application without a window, with small pictures, for tests.

use std::{
    path::{Path, PathBuf},
    sync::Arc,
    time::{Duration, Instant},
};

use ambray::{BackendChoice, RendererOptions, settings::Settings};
use ambray_view::{
    app::App,
    engine::{Engine, EngineOptions, Wake},
    model::{Model, Resolution, SceneRef},
    panels::action::Action,
};
use egui_kittest::{Harness, kittest::Queryable as _};

/// Whoever waits longer than this waits for something that does not come.
const WATCHDOG: Duration = Duration::from_secs(120);

/// The application with its hands and eyes.
pub(crate) struct Desk {
    pub(crate) harness: Harness<'static, App>,
}

/// A file that falls on the window.
#[derive(Debug)]
pub(crate) struct Dropped(pub(crate) PathBuf);

impl egui::DroppedFile for Dropped {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

impl Desk {
    /// Begins with the built-in scene and one ray a pixel.
    pub(crate) fn new() -> Self {
        let renderer = RendererOptions { backend: BackendChoice::Cpu, ..RendererOptions::default() };
        let wake = Wake(Arc::new(|| {}));
        let engine = Engine::new(EngineOptions { renderer, threads: 1, keeps_on_device: false, wake });
        let settings = Settings { spp: 1, ..Settings::default() };
        let mut model = Model::new(SceneRef::new("atrium"), settings);
        model.resolution = Resolution::Window(0.04);
        let app = App::new(model, engine);
        let builder = Harness::builder().with_size([1440.0, 2600.0]).with_max_steps(16);
        let mut desk = Self { harness: builder.build_ui_state(|ui, app: &mut App| app.ui(ui), app) };
        desk.step(3);
        desk
    }

    pub(crate) fn app(&self) -> &App {
        self.harness.state()
    }

    pub(crate) fn app_mut(&mut self) -> &mut App {
        self.harness.state_mut()
    }

    /// Settings of the edited side.
    pub(crate) fn settings(&self) -> &Settings {
        self.app().model.edited()
    }

    pub(crate) fn step(&mut self, frames: usize) {
        for _ in 0..frames {
            self.harness.step();
        }
    }

    /// Presses what is called `label`.
    pub(crate) fn click(&mut self, label: &str) {
        self.harness.get_by_label(label).click();
        self.step(4);
    }

    pub(crate) fn open_all_groups(&mut self) {
        let groups = Settings::fields().iter().map(|field| field.heading.to_owned());
        self.app_mut().memory.panels.open_groups = groups.collect();
        self.harness.run_steps(20);
    }

    /// Until everything that was asked for is shown.
    pub(crate) fn wait(&mut self) {
        self.step(2);
        self.until(App::is_idle);
    }

    pub(crate) fn until(&mut self, what: impl Fn(&App) -> bool) {
        let start = Instant::now();
        while !what(self.app()) {
            let notices = &self.app().shown.notices;
            assert!(start.elapsed() < WATCHDOG, "what is waited for does not come: {notices:?}");
            self.harness.step();
            std::thread::sleep(Duration::from_millis(2));
        }
        self.step(2);
    }

    pub(crate) fn drop_file(&mut self, path: &str) {
        self.harness.input_mut().dropped_files.push(Arc::new(Dropped(path.into())));
        self.step(3);
    }

    pub(crate) fn perform(&mut self, action: Action) {
        let ctx = self.harness.ctx.clone();
        self.app_mut().perform(&ctx, action);
        self.step(2);
    }

    /// Lets the window's clock go on.
    pub(crate) fn pass(&mut self, seconds: usize) {
        self.step(4 * seconds); // a frame of the test kit takes a quarter of a second
    }
}
