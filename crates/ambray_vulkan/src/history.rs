//! What one frame leaves for the next on the device, where light is accumulated (`ambray_core::temporal`).

use std::sync::Arc;

use ambray_core::{
    camera::{Camera, Projection},
    settings::Settings,
    temporal::{is_comparable, tolerance},
    view::View,
};
use ash::vk::BufferUsageFlags;

use crate::{
    Buffer, Context, Location, Result,
    layout::{MeanPlanes, TemporalConstants},
};

/// Planes of means, by turns read and written, and of where surface points were in the last frame.
#[derive(Debug)]
pub(crate) struct History {
    sets: [Means; 2],
    then_positions: Buffer,
    then_normals: Buffer,
    capacity: u64,
    /// Which set the last frame wrote.
    last: usize,
    /// The last frame; `None` where none can be continued.
    earlier: Option<(Settings, View)>,
    /// Camera of the frame that the last one continued.
    continued: Option<Camera>,
}

/// Means with the guides of their pixels.
#[derive(Debug)]
struct Means {
    positions: Buffer,
    normals: Buffer,
    ambient: Buffer,
    bent: Buffer,
    frames: Buffer,
}

impl Means {
    fn new(context: &Arc<Context>, pixels: u64) -> Result<Self> {
        Ok(Self {
            positions: plane(context, "positions of means", 16 * pixels)?,
            normals: plane(context, "normals of means", 16 * pixels)?,
            ambient: plane(context, "means of openness and near radiance", 16 * pixels)?,
            bent: plane(context, "means of bent normals", 16 * pixels)?,
            frames: plane(context, "frames of means", 4 * pixels)?,
        })
    }

    const fn addresses(&self) -> MeanPlanes {
        MeanPlanes {
            positions: self.positions.address(),
            normals: self.normals.address(),
            ambient: self.ambient.address(),
            bent: self.bent.address(),
            frames: self.frames.address(),
        }
    }
}

fn plane(context: &Arc<Context>, name: &str, size: u64) -> Result<Buffer> {
    let usage = BufferUsageFlags::STORAGE_BUFFER
        | BufferUsageFlags::SHADER_DEVICE_ADDRESS
        | BufferUsageFlags::TRANSFER_SRC;
    context.buffer(name, size, usage, Location::Device)
}

impl History {
    /// For frames of `pixels` pixels, of which there was none yet.
    pub(crate) fn new(context: &Arc<Context>, pixels: u64) -> Result<Self> {
        Ok(Self {
            sets: [Means::new(context, pixels)?, Means::new(context, pixels)?],
            then_positions: plane(context, "positions in the last frame", 16 * pixels)?,
            then_normals: plane(context, "normals in the last frame", 16 * pixels)?,
            capacity: pixels,
            last: 0,
            earlier: None,
            continued: None,
        })
    }

    /// Whether it has room for frames of `pixels` pixels, and not for other ones.
    pub(crate) const fn suits(&self, pixels: u64) -> bool {
        self.capacity == pixels
    }

    /// No earlier frame can be continued any more.
    pub(crate) fn forget(&mut self) {
        self.earlier = None;
    }

    /// Begins the next frame: what it reads and writes. Until it has [ended](Self::end), no frame can be continued.
    pub(crate) fn begin(&mut self, settings: &Settings, view: &View, scene_moved: bool) -> TemporalConstants {
        let earlier = self.earlier.take();
        let earlier = earlier.filter(|(last, seen)| is_comparable((last, seen), (settings, view)));
        self.continued = earlier.map(|(_, seen)| seen.camera);
        let camera = self.continued.as_ref().unwrap_or(&view.camera);
        TemporalConstants {
            earlier: self.sets[self.last].addresses(),
            next: self.sets[1 - self.last].addresses(),
            then_positions: self.then_positions.address(),
            then_normals: self.then_normals.address(),
            eye: camera.position().to_array(),
            forward: camera.forward().to_array(),
            right: camera.right().to_array(),
            up: camera.up().to_array(),
            half_height: camera.half_height(),
            orthographic: matches!(camera.projection(), Projection::Orthographic { .. }).into(),
            has_earlier: self.continued.is_some().into(),
            scene_moved: scene_moved.into(),
            camera_moved: (*camera != view.camera).into(),
            tolerance: tolerance(settings),
        }
    }

    /// Ends the frame that was begun, with all of it written.
    pub(crate) fn end(&mut self, settings: &Settings, view: &View) {
        self.last = 1 - self.last;
        self.earlier = Some((settings.clone(), view.clone()));
    }

    /// Camera of the frame that the last one continued, if it did.
    pub(crate) const fn continued(&self) -> Option<&Camera> {
        self.continued.as_ref()
    }

    /// `vec4` a pixel: where the surface point of the last frame was in the one that it continued.
    pub(crate) const fn then_positions(&self) -> &Buffer {
        &self.then_positions
    }

    /// `float` a pixel: frames of the mean.
    pub(crate) const fn frames(&self) -> &Buffer {
        &self.sets[self.last].frames
    }
}
