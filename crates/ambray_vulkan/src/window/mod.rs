//! Drawing into a window on the device that renders: pictures reach the screen without leaving the device.
//!
//! A [`Screen`] draws textured triangles, such as a library of widgets makes, with the colours as they are: a picture at its
//! own size reaches the window byte for byte. The context must have been opened [for the window](crate::Context::for_window).

mod frame;
mod painter;
mod swapchain;
mod textures;

use std::{ops::Range, sync::Arc};

use bytemuck::{Pod, Zeroable};

use self::{
    frame::InFlight,
    painter::Painter,
    swapchain::{Acquired, Swapchain},
    textures::{Texture, Textures},
};
use crate::{Context, Picture, Result, VulkanError};

pub use self::textures::{Filter, Sampling, Upload};

/// Frames that are drawn while others are being shown.
const IN_FLIGHT: usize = 2;

/// A corner of a triangle.
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Corner {
    /// Place in the window, points from the top left.
    pub position: [f32; 2],
    /// Place in the texture, 0 to 1.
    pub uv: [f32; 2],
    /// Colour that the texture's is multiplied with: display values, premultiplied.
    pub colour: [u8; 4],
}

/// Triangles with one texture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mesh {
    /// Pixels that may be drawn: left, top, width, height, all within the window.
    pub clip: [u32; 4],
    /// Number of the texture.
    pub texture: u64,
    /// Which of the corners' numbers, three for a triangle.
    pub indices: Range<u32>,
    /// What is added to each of those numbers.
    pub first_corner: u32,
}

/// All triangles of a frame, back to front.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Painting {
    /// Corners of all meshes.
    pub corners: Vec<Corner>,
    /// Numbers of corners of all meshes.
    pub indices: Vec<u32>,
    /// What is drawn of them.
    pub meshes: Vec<Mesh>,
    /// Size of the window, points.
    pub size: [f32; 2],
}

/// Pixels of the window: RGBA, row by row from the top.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Copy {
    /// Width and height.
    pub size: [u32; 2],
    /// Four bytes a pixel.
    pub rgba: Vec<u8>,
}

/// What is drawn into a window.
pub struct Screen {
    /// Frames in turn; dropped first, since they wait for what they drew.
    frames: [InFlight; IN_FLIGHT],
    turn: usize,
    textures: Textures,
    swapchain: Swapchain,
    painter: Painter,
    context: Arc<Context>,
}

impl Screen {
    /// Makes everything that is needed to draw into the window of `context`, which has `size` pixels.
    ///
    /// # Errors
    /// If the context was not opened for a window, or if the window takes no pixels of 8 bits a channel.
    pub fn new(context: &Arc<Context>, size: [u32; 2]) -> Result<Self> {
        let format = swapchain::format(context)?;
        let painter = Painter::new(context, format.format)?;
        Ok(Self {
            frames: [InFlight::new(context)?, InFlight::new(context)?],
            turn: 0,
            textures: Textures::default(),
            swapchain: Swapchain::new(context, format, painter.render_pass(), size)?,
            painter,
            context: Arc::clone(context),
        })
    }

    /// Largest width and height of a texture.
    #[must_use]
    pub fn max_texture_side(&self) -> u32 {
        self.context.limits().image_side
    }

    /// The window has `size` pixels now; a side may be 0.
    pub fn resize(&mut self, size: [u32; 2]) {
        self.swapchain.resize(size);
    }

    /// Gives texture `number` new pixels; they are there from the next painting on.
    ///
    /// # Errors
    /// If there is no memory for them, or if a part is to be replaced of a texture that is not there.
    ///
    /// # Panics
    /// If there are not as many bytes as the size says.
    pub fn upload(&mut self, number: u64, upload: &Upload<'_>) -> Result<()> {
        self.textures.upload(&self.context, &self.painter, number, upload)
    }

    /// Makes `picture`, of this device, texture `number`. It is held as long as a frame may use it.
    ///
    /// # Errors
    /// If there is no memory for the descriptor.
    pub fn adopt(&mut self, number: u64, picture: Arc<Picture>, sampling: Sampling) -> Result<()> {
        self.textures.insert(number, Texture::of(&self.painter, picture, sampling)?);
        Ok(())
    }

    /// Forgets texture `number` after the next painting.
    pub fn forget(&mut self, number: u64) {
        self.textures.forget(number);
    }

    /// Whether there is a texture `number`.
    #[must_use]
    pub fn has(&self, number: u64) -> bool {
        self.textures.get(number).is_some()
    }

    /// Draws and shows a frame; meshes whose texture is not there are left out. Waits for the screen if it is not ready for
    /// another one. Gives the pixels back if `wants_copy`, unless nothing can be shown because the window has no area.
    ///
    /// # Errors
    /// If the device fails.
    pub fn paint(&mut self, painting: &Painting, wants_copy: bool) -> Result<Option<Copy>> {
        self.turn = (self.turn + 1) % IN_FLIGHT;
        let frame = &mut self.frames[self.turn];
        frame.wait()?;
        let Some(Acquired { index, is_stale }) = self.swapchain.acquire(frame.acquired())? else {
            return Ok(None);
        };
        let target = self.swapchain.target(index);
        let wants_copy = wants_copy && target.can_be_copied;
        frame.draw(&self.painter, &mut self.textures, painting, &target, wants_copy)?;
        self.swapchain.present(index, is_stale)?;
        if !wants_copy {
            return Ok(None);
        }
        frame.wait()?;
        Ok(frame.copy(&target))
    }

    /// What all frames so far may still use, waited for.
    ///
    /// # Errors
    /// If the device is lost.
    pub fn finish(&mut self) -> Result<()> {
        self.frames.iter_mut().try_for_each(InFlight::wait)
    }
}

impl Drop for Screen {
    fn drop(&mut self) {
        // Only a lost device fails here, and it uses nothing any more.
        let _ = self.finish();
    }
}

impl std::fmt::Debug for Screen {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Screen").field("swapchain", &self.swapchain).finish_non_exhaustive()
    }
}

fn missing(feature: &str) -> VulkanError {
    VulkanError::Missing { device: "the window".into(), feature: feature.to_owned() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn corners_have_no_gaps() {
        assert_eq!(size_of::<Corner>(), 20);
    }
}
