//! The window itself: what the system says, in the order of its life.

use std::{
    sync::Arc,
    time::{Duration, Instant},
};

use ambray::settings::Settings;
use anyhow::Context as _;
use egui::{ViewportId, ViewportInfo};
use winit::{
    application::ApplicationHandler,
    dpi::LogicalSize,
    event::WindowEvent,
    event_loop::{ActiveEventLoop, ControlFlow, EventLoopProxy},
    window::{Window, WindowAttributes, WindowId},
};

use super::{
    ViewOptions, Wake,
    icon::icon,
    present::{self, Opened, Painting, Presenter},
    script::{Runner, Script, Wish},
};
use crate::{
    app::{App, Severity},
    engine::{Engine, EngineOptions, Wake as EngineWake},
    memory::{Memory, Store, WindowState},
    model::{Model, Resolution, Side},
};

/// Size of the window where none is remembered, points.
const SIZE: (f32, f32) = (1440.0, 900.0);
/// Smallest size that has room for the panels, points.
const LEAST: (f32, f32) = (480.0, 320.0);
/// How often a script that waits looks whether it has waited for too long.
const PATROL: Duration = Duration::from_millis(200);

/// The window with everything in it, or what is needed to open it.
pub(super) struct Shell {
    options: ViewOptions,
    proxy: EventLoopProxy<Wake>,
    script: Option<Script>,
    open: Option<Open>,
    failure: Option<anyhow::Error>,
}

/// A window that is open. Fields are dropped in this order.
struct Open {
    app: App,
    presenter: Box<dyn Presenter>,
    system: egui_winit::State,
    info: ViewportInfo,
    script: Option<Runner>,
    /// When the next frame is to be drawn, if ever.
    draw_at: Option<Instant>,
    title: String,
    is_visible: bool,
    window: Arc<Window>,
}

impl Shell {
    pub(super) fn new(options: ViewOptions, script: Option<Script>, proxy: EventLoopProxy<Wake>) -> Self {
        Self { options, proxy, script, open: None, failure: None }
    }

    /// What is left of the window: the settings that were edited last, or what went wrong.
    pub(super) fn finish(self) -> anyhow::Result<Settings> {
        let mut settings = self.options.settings.unwrap_or_default();
        if let Some(mut open) = self.open {
            // Nobody answers for it any more, and threads may take their time to end.
            open.window.set_visible(false);
            if let Some(warning) = open.app.finish() {
                log::warn!("{warning}");
            }
            settings = open.app.model.of(open.app.model.editing).clone();
            if let (None, Some(script)) = (&self.failure, &open.script) {
                script.check_done()?;
            }
        }
        self.failure.map_or(Ok(settings), Err)
    }

    fn open(&mut self, event_loop: &ActiveEventLoop) -> anyhow::Result<Open> {
        let options = &self.options;
        let (store, memory, warning) = match &options.memory {
            Some(path) => Store::open(path.clone()),
            None => (Store::none(), Memory::default(), None),
        };
        let title = title(&options.scene.path.display().to_string());
        let remembered =
            memory.window.unwrap_or(WindowState { width: SIZE.0, height: SIZE.1, is_maximized: false });
        let attributes = WindowAttributes::default()
            .with_title(&title)
            .with_inner_size(LogicalSize::new(remembered.width.max(LEAST.0), remembered.height.max(LEAST.1)))
            .with_min_inner_size(LogicalSize::new(LEAST.0, LEAST.1))
            .with_maximized(remembered.is_maximized)
            .with_window_icon(icon())
            // Shown when there is something to see.
            .with_visible(false);
        let Opened { window, presenter, renderer, pictures } =
            present::open(event_loop, &attributes, &options.renderer)?;

        let context = egui::Context::default();
        let proxy = self.proxy.clone();
        context.set_request_repaint_callback(move |request| {
            // A moment too far away to name never comes.
            if let Some(at) = Instant::now().checked_add(request.delay) {
                // A window that is closed draws nothing.
                let _ = proxy.send_event(Wake::Draw(at));
            }
        });
        let system = egui_winit::State::new(
            context,
            ViewportId::ROOT,
            &window,
            Some(window.scale_factor() as f32),
            window.theme(),
            Some(presenter.max_texture_side()),
        );
        let proxy = self.proxy.clone();
        let engine = Engine::new(EngineOptions {
            renderer,
            threads: options.threads,
            keeps_on_device: pictures.is_some(),
            wake: EngineWake(Arc::new(move || {
                let _ = proxy.send_event(Wake::Engine);
            })),
        });
        let settings = options.settings.clone().unwrap_or_else(|| {
            let mut settings = Settings::default();
            memory.settings.apply(&mut settings);
            settings
        });
        let mut model = Model::new(options.scene.clone(), settings);
        // A size that was asked for is kept; the usual one stands for the window's.
        let size = model.of(Side::A).size;
        if size != Settings::default().size {
            model.resolution = Resolution::Fixed(size);
        }
        let mut app = App::remembering(model, engine, memory, store);
        if let Some(warning) = warning {
            app.shown.notify(Severity::Warning, warning);
        }
        if let Some(pictures) = pictures {
            app.canvas_mut().set_textures(pictures);
        }
        Ok(Open {
            app,
            presenter,
            system,
            info: ViewportInfo::default(),
            script: self.script.take().map(Runner::new),
            draw_at: Some(Instant::now()),
            title,
            is_visible: false,
            window,
        })
    }

    /// Does `work` with the window; closes it if that fails.
    fn attempt(
        &mut self,
        event_loop: &ActiveEventLoop,
        work: impl FnOnce(&mut Open, &ActiveEventLoop) -> anyhow::Result<()>,
    ) {
        let Some(open) = &mut self.open else { return };
        if let Err(error) = work(open, event_loop) {
            self.failure.get_or_insert(error);
            event_loop.exit();
        }
    }
}

impl Open {
    /// One frame.
    fn draw(&mut self, event_loop: &ActiveEventLoop) -> anyhow::Result<()> {
        self.draw_at = None;
        let size = self.window.inner_size();
        if size.width == 0 || size.height == 0 {
            return Ok(()); // minimised; what brings it back is an event
        }
        if let Some(script) = &mut self.script {
            script.begin_frame(&mut self.app, &self.window, &mut self.system)?;
        }
        let context = self.system.egui_ctx().clone();
        egui_winit::update_viewport_info(&mut self.info, &context, &self.window, false);
        let mut input = self.system.take_egui_input(&self.window);
        input.viewports.insert(ViewportId::ROOT, std::mem::take(&mut self.info));
        if let Some(script) = &mut self.script {
            script.add_input(&mut input);
        }
        let output = context.run_ui(input, |ui| self.app.ui(ui));
        self.system.handle_platform_output(&self.window, output.platform_output);
        for (_, viewport) in output.viewport_output {
            let actions = &mut Vec::new(); // cut, copy and paste come as events already
            egui_winit::process_viewport_commands(
                &context,
                &mut self.info,
                viewport.commands,
                &self.window,
                actions,
            );
        }
        let painting = Painting {
            primitives: context.tessellate(output.shapes, output.pixels_per_point),
            textures: output.textures_delta,
            pixels_per_point: output.pixels_per_point,
            wants_copy: self.script.as_ref().is_some_and(Runner::wants_copy),
        };
        let copy = self.presenter.paint(&self.window, painting)?;
        if !std::mem::replace(&mut self.is_visible, true) {
            self.window.set_visible(true);
        }
        self.retitle();
        self.remember_size();
        if self.app.is_quitting() {
            event_loop.exit();
        }
        if let Some(script) = &mut self.script {
            match script.end_frame(&self.app, &self.window, copy)? {
                Wish::NextFrame => self.draw_by(Instant::now()),
                Wish::News => self.draw_by(Instant::now() + PATROL),
                Wish::Close => event_loop.exit(),
            }
        }
        Ok(())
    }

    /// Sees to it that a frame is drawn at `at`, or before.
    fn draw_by(&mut self, at: Instant) {
        self.draw_at = Some(self.draw_at.map_or(at, |before| before.min(at)));
    }

    fn on_event(&mut self, event_loop: &ActiveEventLoop, event: &WindowEvent) -> anyhow::Result<()> {
        match event {
            WindowEvent::RedrawRequested => return self.draw(event_loop),
            WindowEvent::CloseRequested | WindowEvent::Destroyed => event_loop.exit(),
            WindowEvent::Resized(size) => self.presenter.resize(*size),
            _ => {}
        }
        if self.system.on_window_event(&self.window, event).repaint {
            self.draw_by(Instant::now());
        }
        Ok(())
    }

    /// Tells the memory how large the window is; while it fills the screen, how large it was before.
    fn remember_size(&mut self) {
        if self.window.fullscreen().is_some() || self.script.is_some() {
            return;
        }
        let is_maximized = self.window.is_maximized();
        let size = self.window.inner_size().to_logical::<f32>(self.window.scale_factor());
        let now = WindowState { width: size.width, height: size.height, is_maximized };
        let before = self.app.memory.window.unwrap_or(now);
        self.app.memory.window =
            Some(if is_maximized { WindowState { is_maximized, ..before } } else { now });
    }

    /// Names the scene in the window's title.
    fn retitle(&mut self) {
        let title = title(&self.app.model.scene.path.display().to_string());
        if title != self.title {
            self.window.set_title(&title);
            self.title = title;
        }
    }
}

impl ApplicationHandler<Wake> for Shell {
    fn resumed(&mut self, event_loop: &ActiveEventLoop) {
        if self.open.is_some() {
            return;
        }
        match self.open(event_loop).context("the window cannot be opened") {
            Ok(open) => self.open = Some(open),
            Err(error) => {
                self.failure = Some(error);
                event_loop.exit();
            }
        }
    }

    fn user_event(&mut self, event_loop: &ActiveEventLoop, wake: Wake) {
        let at = match wake {
            Wake::Engine => {
                if let Some(open) = &mut self.open {
                    open.app.hear();
                }
                Instant::now()
            }
            Wake::Draw(at) => at,
            Wake::Stop => {
                // Its steps that are left are not missed.
                self.script = None;
                if let Some(open) = &mut self.open {
                    open.script = None;
                }
                return event_loop.exit();
            }
        };
        if let Some(open) = &mut self.open {
            open.draw_by(at);
        }
    }

    fn window_event(&mut self, event_loop: &ActiveEventLoop, id: WindowId, event: WindowEvent) {
        // A window that Vulkan could not draw into is gone, and still has something to say.
        if self.open.as_ref().is_some_and(|open| open.window.id() == id) {
            self.attempt(event_loop, |open, event_loop| open.on_event(event_loop, &event));
        }
    }

    fn about_to_wait(&mut self, event_loop: &ActiveEventLoop) {
        let Some(open) = &mut self.open else { return };
        // Drawn when the system says so, which is once a refresh of the screen; asleep otherwise.
        event_loop.set_control_flow(match open.draw_at {
            Some(at) if at <= Instant::now() => {
                open.draw_at = None;
                open.window.request_redraw();
                ControlFlow::Wait
            }
            Some(at) => ControlFlow::WaitUntil(at),
            None => ControlFlow::Wait,
        });
    }
}

/// The window's title while it shows `scene`.
fn title(scene: &str) -> String {
    format!("{scene} – Ambray")
}
