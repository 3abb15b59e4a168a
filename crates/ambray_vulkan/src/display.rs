//! Planes of the last frame as pictures, without a way through the host (`ambray_core::display`).

use std::sync::Arc;

use ambray_core::{
    aov::{Aov, AovKind},
    display,
    settings::{Auto, Ramp, Range, Settings},
};
use ash::vk::BufferUsageFlags;

use crate::{
    Buffer, Context, Location, Picture, Recorder, Result, Work,
    layout::{self, BOX_WORDS, FILTER_HEIGHT, FILTER_WIDTH, Push, Specialization, finite},
    picture::Pictures,
    pipeline::{ComputePipeline, Interface},
    reduce, shaders,
};

/// The programs that show planes.
#[derive(Debug)]
pub(crate) struct DisplayPrograms {
    /// Lives as long as what was made with it.
    interface: Arc<Interface>,
    bounds: ComputePipeline,
    show: ComputePipeline,
}

impl DisplayPrograms {
    /// Compiles them for what [`specialization`] returned.
    pub(crate) fn new(interface: &Arc<Interface>, specialization: &Specialization) -> Result<Self> {
        let compute = |spirv: &[u8]| ComputePipeline::new(interface, spirv, specialization);
        Ok(Self {
            interface: Arc::clone(interface),
            bounds: compute(shaders::BOUNDS)?,
            show: compute(shaders::SHOW)?,
        })
    }
}

/// The constants of a frame that planes are read by; all others are those of the defaults, so that few programs do for all
/// settings.
pub(crate) fn specialization(settings: &Settings) -> Specialization {
    let of = |settings: &Settings| Specialization::of(settings, false, false);
    let Specialization { source, after_filter, .. } = of(settings);
    Specialization { source, after_filter, ..of(&Settings::default()) }
}

/// What pictures are painted with.
#[derive(Debug)]
pub(crate) struct Painter {
    constants: Buffer,
    bounds: Buffer,
    ramp: Option<(Ramp, Buffer)>,
    /// Bytes of a picture, before they become an image.
    pixels: Option<Buffer>,
    pictures: Pictures,
    context: Arc<Context>,
}

const SHADER: BufferUsageFlags = BufferUsageFlags::from_raw(
    BufferUsageFlags::STORAGE_BUFFER.as_raw() | BufferUsageFlags::SHADER_DEVICE_ADDRESS.as_raw(),
);

impl Painter {
    pub(crate) fn new(context: &Arc<Context>) -> Result<Self> {
        let size = size_of::<layout::Display>() as u64;
        Ok(Self {
            constants: context.buffer("how a plane is shown", size, SHADER, Location::Upload)?,
            bounds: context.buffer(
                "box of a plane",
                4 * u64::from(BOX_WORDS),
                SHADER | BufferUsageFlags::TRANSFER_DST,
                Location::Device,
            )?,
            ramp: None,
            pixels: None,
            pictures: Pictures::default(),
            context: Arc::clone(context),
        })
    }

    /// Makes ready what a picture of `size` needs, and writes its addresses to the constants of the frame. Nothing of an
    /// earlier picture may be under way.
    pub(crate) fn prepare(
        &mut self,
        aov: Aov,
        settings: &Settings,
        size: [u32; 2],
        view: &mut layout::View,
    ) -> Result<Arc<Picture>> {
        let bytes = 4 * u64::from(size[0]) * u64::from(size[1]);
        let pixels = match self.pixels.take() {
            Some(pixels) if pixels.size() == bytes => pixels,
            old => {
                drop(old);
                let usage = SHADER | BufferUsageFlags::TRANSFER_SRC;
                self.context.buffer("bytes of a picture", bytes, usage, Location::Device)?
            }
        };
        view.outputs = self.pixels.insert(pixels).address();
        let (has_range, Range(range)) = match settings.range {
            Auto::Value(range) => (true, range),
            Auto::Auto => (false, Range([0.0, 1.0])),
        };
        let constants = layout::Display {
            ramp: self.ramp(settings.ramp)?,
            bounds: self.bounds.address(),
            plane: aov as u32,
            tone_map: settings.tone_map as u32,
            brightness: finite(libm::exp2f(settings.exposure)),
            has_range: has_range.into(),
            range,
        };
        self.constants.write(0, &[constants]);
        view.inputs = self.constants.address();
        self.pictures.free(&self.context, (size[0], size[1]))
    }

    /// Address of the colours of `ramp`; 0 for grey.
    fn ramp(&mut self, ramp: Ramp) -> Result<u64> {
        if ramp == Ramp::Grey {
            return Ok(0);
        }
        if let Some((kept, colors)) = &self.ramp
            && *kept == ramp
        {
            return Ok(colors.address());
        }
        let color = |grey: u8| {
            let [r, g, b] = display::color(ramp, grey);
            u32::from_le_bytes([r, g, b, u8::MAX])
        };
        let colors: Vec<u32> = (0..=u8::MAX).map(color).collect();
        let colors = self.context.upload("colours of a ramp", SHADER, &colors)?;
        Ok(self.ramp.insert((ramp, colors)).1.address())
    }

    /// Records the painting of `picture`, which was prepared; `view` is the address of the constants of the frame.
    ///
    /// # Panics
    /// If nothing was prepared.
    pub(crate) fn record(
        &self,
        recorder: &mut Recorder<'_>,
        programs: &DisplayPrograms,
        aov: Aov,
        view: u64,
        picture: &Picture,
    ) {
        let (width, height) = picture.size();
        if spans_picture(aov) {
            // All bits set: empty.
            recorder.fill(&self.bounds, u32::MAX);
            recorder.barrier(Work::Transfer, Work::Compute);
            let push = Push { scene: 0, view, origin: [0; 2], extent: reduce::extent(width * height) };
            programs.bounds.record(recorder, &programs.interface, reduce::WORKGROUP, push);
            recorder.barrier(Work::Compute, Work::Compute);
        }
        let push = Push { scene: 0, view, origin: [0; 2], extent: [width, height] };
        programs.show.record(recorder, &programs.interface, [FILTER_WIDTH, FILTER_HEIGHT], push);
        recorder.paint(self.pixels.as_ref().expect("prepared"), picture);
    }
}

/// Whether the colours of a pixel depend on the values of all pixels.
fn spans_picture(aov: Aov) -> bool {
    matches!(aov.kind(), AovKind::Depth | AovKind::Position | AovKind::Count | AovKind::Motion)
}
