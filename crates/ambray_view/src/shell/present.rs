//! What draws into the window.

use egui::{ClippedPrimitive, TexturesDelta};
use winit::{dpi::PhysicalSize, window::Window};

use crate::engine::Pixels;

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
