//! Draws with OpenGL: where the processor renders, and needs no Vulkan.
#![allow(
    unsafe_code,
    reason = "OpenGL is loaded from the system, and its context is made from handles of the window"
)]

use std::{ffi::CString, num::NonZeroU32, sync::Arc};

use anyhow::{Context as _, anyhow};
use egui_glow::{Painter, glow};
use glutin::{
    config::{Config, ConfigTemplateBuilder},
    context::{ContextApi, ContextAttributesBuilder, NotCurrentContext, PossiblyCurrentContext},
    display::GetGlDisplay as _,
    prelude::{GlConfig as _, GlDisplay as _, GlSurface as _, NotCurrentGlContext as _},
    surface::{Surface, SwapInterval, WindowSurface},
};
use glutin_winit::{ApiPreference, DisplayBuilder, GlWindow as _};
use winit::{
    dpi::PhysicalSize,
    event_loop::ActiveEventLoop,
    raw_window_handle::HasWindowHandle as _,
    window::{Window, WindowAttributes},
};

use super::present::{Painting, Presenter};
use crate::engine::Pixels;

/// A window that OpenGL draws into. Fields are dropped in this order.
pub(super) struct Gl {
    painter: Painter,
    surface: Surface<WindowSurface>,
    context: PossiblyCurrentContext,
}

impl Gl {
    /// Opens a window with `attributes` and the context to draw into it.
    pub(super) fn open(
        event_loop: &ActiveEventLoop,
        attributes: WindowAttributes,
    ) -> anyhow::Result<(Window, Self)> {
        let template = ConfigTemplateBuilder::new().with_depth_size(0).with_stencil_size(0);
        let (window, config) = DisplayBuilder::new()
            // GLX, WGL or CGL first: EGL on X11 is not there on every system.
            .with_preference(ApiPreference::FallbackEgl)
            .with_window_attributes(Some(attributes.clone()))
            .build(event_loop, template, |configs| {
                configs.min_by_key(plainness).expect("at least one configuration")
            })
            .map_err(|error| anyhow!("OpenGL: {error}"))?;
        let window = match window {
            Some(window) => window,
            None => glutin_winit::finalize_window(event_loop, attributes, &config).context("the window")?,
        };
        let context = context(&window, &config)?;
        let attributes = window.build_surface_attributes(Default::default()).context("the window")?;
        // SAFETY: the attributes hold the handle of `window`, which the shell drops after the presenter.
        let surface = unsafe { config.display().create_window_surface(&config, &attributes) }
            .context("OpenGL surface")?;
        let context = context.make_current(&surface).context("OpenGL context")?;
        // Where the system does not wait for the screen, frames are drawn at once: no loss.
        let _ = surface.set_swap_interval(&context, SwapInterval::Wait(NonZeroU32::MIN));
        let load = |name: &str| {
            let name = CString::new(name).expect("names of OpenGL have no zeros");
            config.display().get_proc_address(&name)
        };
        // SAFETY: the context is current, and `load` gives its functions.
        let gl = unsafe { glow::Context::from_loader_function(load) };
        // Not dithered: pixels are meant as they are.
        let painter = Painter::new(Arc::new(gl), "", None, false)?;
        Ok((window, Self { painter, surface, context }))
    }
}

/// Configurations with eight bits a channel and nothing besides come first.
fn plainness(config: &Config) -> (bool, u8, bool) {
    use glutin::config::ColorBufferType;
    let is_rgb8 =
        config.color_buffer_type() == Some(ColorBufferType::Rgb { r_size: 8, g_size: 8, b_size: 8 });
    (!is_rgb8, config.num_samples(), config.srgb_capable())
}

/// A context for `window`: OpenGL, or OpenGL ES where only that is there.
fn context(window: &Window, config: &Config) -> anyhow::Result<NotCurrentContext> {
    let handle = window.window_handle().context("the window")?.as_raw();
    let plain = ContextAttributesBuilder::new().build(Some(handle));
    let embedded =
        ContextAttributesBuilder::new().with_context_api(ContextApi::Gles(None)).build(Some(handle));
    // SAFETY: the handle is that of `window`, which the shell drops after the presenter that the context goes to.
    let make = |attributes| unsafe { config.display().create_context(config, attributes) };
    make(&plain).or_else(|_| make(&embedded)).context("OpenGL context")
}

impl Presenter for Gl {
    fn max_texture_side(&self) -> usize {
        self.painter.max_texture_side()
    }

    fn resize(&mut self, size: PhysicalSize<u32>) {
        if let (Some(width), Some(height)) = (NonZeroU32::new(size.width), NonZeroU32::new(size.height)) {
            self.surface.resize(&self.context, width, height);
        }
    }

    fn paint(&mut self, window: &Window, mut painting: Painting) -> anyhow::Result<Option<Pixels>> {
        let size: [u32; 2] = window.inner_size().into();
        self.painter.clear(size, [0.0, 0.0, 0.0, 1.0]);
        self.painter.paint_and_update_textures(
            size,
            painting.pixels_per_point,
            &painting.primitives,
            &mut painting.textures,
        );
        let copy = painting.wants_copy.then(|| {
            let image = self.painter.read_screen_rgba(size);
            // What is behind the window is not part of it.
            let rgba = image.pixels.iter().flat_map(|pixel| [pixel.r(), pixel.g(), pixel.b(), 255]).collect();
            Pixels { width: size[0], height: size[1], rgba }
        });
        window.pre_present_notify();
        self.surface.swap_buffers(&self.context).context("OpenGL")?;
        Ok(copy)
    }
}

impl Drop for Gl {
    fn drop(&mut self) {
        self.painter.destroy();
    }
}
