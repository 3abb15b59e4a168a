//! What draws into the window.

use std::sync::Arc;

use ambray::{BackendChoice, RendererOptions, vulkan::Context};
use egui::{ClippedPrimitive, TexturesDelta};
use winit::{
    dpi::PhysicalSize,
    event_loop::ActiveEventLoop,
    window::{Window, WindowAttributes},
};

use super::{
    gl::Gl,
    vulkan::{self, Vulkan},
};
use crate::{canvas::PictureTextures, engine::Pixels};

/// What is to be drawn.
#[derive(Debug)]
pub(super) struct Painting {
    /// Triangles, back to front.
    pub(super) primitives: Vec<ClippedPrimitive>,
    /// Textures that have changed, and those that are not needed after this painting.
    pub(super) textures: TexturesDelta,
    /// Pixels of the window per point of the triangles.
    pub(super) pixels_per_point: f32,
    /// Whether the pixels of the window are wanted back.
    pub(super) wants_copy: bool,
}

/// Draws into the window. Colours are taken as they are: a texture that is drawn at its size reaches the screen byte for byte.
pub(super) trait Presenter {
    /// Largest width and height of a texture.
    fn max_texture_side(&self) -> usize;

    /// The window has another size.
    fn resize(&mut self, size: PhysicalSize<u32>);

    /// Draws, and shows what was drawn. Gives the pixels of the window where they are wanted and there are any.
    fn paint(&mut self, window: &Window, painting: Painting) -> anyhow::Result<Option<Pixels>>;
}

/// A window with what draws into it.
pub(super) struct Opened {
    pub(super) window: Arc<Window>,
    pub(super) presenter: Box<dyn Presenter>,
    /// How to render, with the device that draws where that renders, too.
    pub(super) renderer: RendererOptions,
    /// The textures of pictures that stay on the device, where there are such.
    pub(super) pictures: Option<Box<dyn PictureTextures>>,
}

/// Opens a window with `attributes` and the best that there is to draw into it: Vulkan if a device is to render that can draw,
/// else OpenGL.
pub(super) fn open(
    event_loop: &ActiveEventLoop,
    attributes: &WindowAttributes,
    options: &RendererOptions,
) -> anyhow::Result<Opened> {
    let mut renderer = options.clone();
    if options.backend != BackendChoice::Cpu {
        match Vulkan::open(event_loop, attributes.clone(), options) {
            Ok((window, presenter)) => {
                renderer.shared = Some(presenter.device().clone());
                let pictures = Box::new(presenter.pictures().clone());
                return Ok(Opened {
                    window,
                    presenter: Box::new(presenter),
                    renderer,
                    pictures: Some(pictures),
                });
            }
            Err(error) if options.backend == BackendChoice::Vulkan => {
                // A device that renders but cannot draw is still what was asked for.
                Context::new(&vulkan::wanted(options))?;
                log::warn!("pictures take the way through the processor's memory: {error:#}");
            }
            Err(error) => log::info!("the window is drawn by OpenGL: {error:#}"),
        }
    }
    let (window, presenter) = Gl::open(event_loop, attributes.clone())?;
    Ok(Opened { window: Arc::new(window), presenter: Box::new(presenter), renderer, pictures: None })
}
