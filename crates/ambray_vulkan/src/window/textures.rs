//! The textures of a window: pixels that were uploaded, and pictures that the device made.

use std::{any::Any, collections::HashMap, sync::Arc};

use ash::vk;

use super::{
    missing,
    painter::{Descriptor, Painter},
};
use crate::{
    Buffer, Context, Location, Picture, Recorder, Result,
    image::{transition, whole_layer},
};

/// How a texture is looked up between its pixels.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum Filter {
    /// The nearest pixel.
    Nearest,
    /// A mixture of the four around.
    #[default]
    Linear,
}

/// How a texture is sampled; beyond its edges the nearest pixel counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub struct Sampling {
    /// Where it is shown larger than it is.
    pub magnified: Filter,
    /// Where it is shown smaller.
    pub minified: Filter,
}

/// New pixels of a texture.
#[derive(Clone, Copy, Debug)]
pub struct Upload<'a> {
    /// Where they go, from the top left; `None` makes a new texture of their size.
    pub at: Option<[u32; 2]>,
    /// Width and height, above 0.
    pub size: [u32; 2],
    /// Premultiplied display values, row by row from the top, four bytes a pixel.
    pub rgba: &'a [u8],
    /// How the texture is sampled; counts for new ones.
    pub sampling: Sampling,
}

/// What must live as long as frames that use it.
pub(super) type Keep = Box<dyn Any + Send>;

/// Something to sample.
pub(super) struct Texture {
    descriptor: Descriptor,
    picture: Arc<Picture>,
    /// Whether it is uploaded to; pictures of others are only looked at.
    is_own: bool,
}

impl Texture {
    /// A texture that shows `picture`.
    pub(super) fn of(painter: &Painter, picture: Arc<Picture>, sampling: Sampling) -> Result<Self> {
        Ok(Self { descriptor: painter.descriptor(picture.view(), sampling)?, picture, is_own: false })
    }

    pub(super) const fn set(&self) -> vk::DescriptorSet {
        self.descriptor.set()
    }
}

/// Pixels on their way to an image.
struct Pending {
    staging: Buffer,
    image: vk::Image,
    at: [u32; 2],
    size: [u32; 2],
    is_new: bool,
}

/// All textures, and what is to happen to them.
#[derive(Default)]
pub(super) struct Textures {
    by_number: HashMap<u64, Texture>,
    pending: Vec<Pending>,
    /// To be forgotten after the next painting.
    leaving: Vec<u64>,
    /// No longer in use by frames to come.
    garbage: Vec<Keep>,
}

impl Textures {
    pub(super) fn get(&self, number: u64) -> Option<&Texture> {
        self.by_number.get(&number)
    }

    pub(super) fn insert(&mut self, number: u64, texture: Texture) {
        self.leaving.retain(|&leaving| leaving != number);
        if let Some(old) = self.by_number.insert(number, texture) {
            self.garbage.push(Box::new(old));
        }
    }

    pub(super) fn forget(&mut self, number: u64) {
        self.leaving.push(number);
    }

    pub(super) fn upload(
        &mut self,
        context: &Arc<Context>,
        painter: &Painter,
        number: u64,
        upload: &Upload<'_>,
    ) -> Result<()> {
        let Upload { at, size, rgba, sampling } = *upload;
        assert_eq!(rgba.len() as u64, u64::from(size[0]) * u64::from(size[1]) * 4, "four bytes a pixel");
        if at.is_none() {
            let picture = Arc::new(Picture::new(context, size.into())?);
            self.insert(number, Texture { is_own: true, ..Texture::of(painter, picture, sampling)? });
        }
        let Some(Texture { picture, is_own: true, .. }) = self.by_number.get(&number) else {
            return Err(missing("the texture of which a part is replaced"));
        };
        let (corner, (width, height)) = (at.unwrap_or_default(), picture.size());
        let fits = |i: usize, side| corner[i].checked_add(size[i]).is_some_and(|end| end <= side);
        if !fits(0, width) || !fits(1, height) {
            return Err(missing("room in the texture of which a part is replaced"));
        }
        let image = picture.image();
        let usage = vk::BufferUsageFlags::TRANSFER_SRC;
        let mut staging = context.buffer("texture's pixels", rgba.len() as u64, usage, Location::Upload)?;
        staging.write(0, rgba);
        self.pending.push(Pending { staging, image, at: corner, size, is_new: at.is_none() });
        Ok(())
    }

    /// Records the copies that are pending. What they use goes to `keep`, with all that frames to come do not need.
    pub(super) fn record(&mut self, recorder: &mut Recorder<'_>, keep: &mut Vec<Keep>) {
        for Pending { staging, image, at, size, is_new } in self.pending.drain(..) {
            copy(recorder, &staging, image, at, size, is_new);
            keep.push(Box::new(staging));
        }
        keep.append(&mut self.garbage);
    }

    /// After a painting: what was to be forgotten goes to `keep`.
    pub(super) fn leave(&mut self, keep: &mut Vec<Keep>) {
        for number in self.leaving.drain(..) {
            if let Some(texture) = self.by_number.remove(&number) {
                keep.push(Box::new(texture));
            }
        }
    }
}

/// Records a copy of `staging` to a part of `image`, which is sampled before and after.
fn copy(
    recorder: &mut Recorder<'_>,
    staging: &Buffer,
    image: vk::Image,
    at: [u32; 2],
    size: [u32; 2],
    is_new: bool,
) {
    use vk::{AccessFlags as Access, ImageLayout as Layout, PipelineStageFlags as Stage};
    let (device, buffer) = (&recorder.context().device, recorder.raw());
    let sampled = Layout::SHADER_READ_ONLY_OPTIMAL;
    let old = if is_new { Layout::UNDEFINED } else { sampled };
    let before =
        transition(image, [old, Layout::TRANSFER_DST_OPTIMAL], [Access::empty(), Access::TRANSFER_WRITE]);
    let after = transition(
        image,
        [Layout::TRANSFER_DST_OPTIMAL, sampled],
        [Access::TRANSFER_WRITE, Access::SHADER_READ],
    );
    let region = vk::BufferImageCopy::default()
        .image_subresource(whole_layer())
        .image_offset(vk::Offset3D { x: at[0] as i32, y: at[1] as i32, z: 0 })
        .image_extent(vk::Extent3D { width: size[0], height: size[1], depth: 1 });
    let none = vk::DependencyFlags::empty();
    // SAFETY: the buffer is being recorded, outside of render passes; the region was checked against the image, and the
    // staging buffer holds as many bytes as it has pixels; both live until the submission is through, and earlier copies to
    // the image are ordered before by their own barriers.
    unsafe {
        let (read, write) = (Stage::FRAGMENT_SHADER | Stage::TRANSFER, Stage::TRANSFER);
        device.cmd_pipeline_barrier(buffer, read, write, none, &[], &[], &[before]);
        let layout = Layout::TRANSFER_DST_OPTIMAL;
        device.cmd_copy_buffer_to_image(buffer, staging.handle(), image, layout, &[region]);
        device.cmd_pipeline_barrier(buffer, write, read, none, &[], &[], &[after]);
    }
}
