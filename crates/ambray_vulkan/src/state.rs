//! What is kept from frame to frame: planes, programs, sample tables, the top-level structure.

use std::sync::Arc;

use ambray_core::{
    frame::FrameStats,
    settings::{Sampling, Sequence, Settings, Temporal},
    view::View,
};
use ash::vk::BufferUsageFlags;

use crate::{
    Acceleration, Buffer, CommandSet, Context, Device, DeviceKind, Location, Result, TopLevel, TraceMode,
    constants::{self, SampleTables},
    display::Painter,
    history::History,
    layout::{self, Specialization},
    pipeline::{Interface, ProgramCache, Programs},
    planes::Planes,
    reduce::Sums,
    schedule::Budget,
};

/// What a frame or a list of points is evaluated with.
pub(crate) struct Inputs<'a> {
    pub(crate) settings: &'a Settings,
    pub(crate) view: &'a View,
    /// Pixels, or points folded into rows.
    pub(crate) size: [u32; 2],
    pub(crate) count: u32,
}

/// What decides the sample tables.
type SampleKey = (Sampling, Sequence, u32, u32, u32);

const fn sample_key(settings: &Settings) -> SampleKey {
    (settings.sampling, settings.sequence, settings.spp, settings.frame, settings.seed)
}

/// A frame that the planes hold, all of it.
#[derive(Clone, Debug)]
pub(crate) struct Drawn {
    pub(crate) settings: Settings,
    pub(crate) view: View,
    /// With the addresses of the planes, and of what is accumulated.
    pub(crate) constants: layout::View,
    pub(crate) stats: FrameStats,
}

/// Used by one frame at a time.
#[derive(Debug)]
pub(crate) struct State {
    /// Dropped first: waits for what uses the rest.
    pub(crate) commands: CommandSet,
    pub(crate) top: TopLevel,
    pub(crate) view_buffer: Buffer,
    pub(crate) budget: Budget,
    /// Whether the budget follows the speed of the device.
    pub(crate) adapts: bool,
    /// Whether a frame of the current pose was rendered.
    pub(crate) rendered: bool,
    /// The frame that the planes hold; `None` while they hold none, or something else.
    pub(crate) drawn: Option<Drawn>,
    pub(crate) sums: Sums,
    /// Made when a plane is first shown.
    pub(crate) painter: Option<Painter>,
    planes: Option<Planes>,
    /// Where light is accumulated over frames.
    history: Option<History>,
    samples: Option<(SampleKey, Buffer, Buffer)>,
    lights: Option<(Vec<layout::Light>, Buffer)>,
    programs: Arc<ProgramCache>,
    pub(crate) interface: Arc<Interface>,
    context: Arc<Context>,
    mode: TraceMode,
}

impl State {
    /// `mode` is resolved.
    pub(crate) fn new(device: &Device, acceleration: &Acceleration, mode: TraceMode) -> Result<Self> {
        let context = device.context();
        let top = TopLevel::new(context, acceleration)?;
        let interface = Interface::new(context)?;
        interface.bind(top.handle());
        let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let view_buffer =
            context.buffer("view", size_of::<layout::View>() as u64, usage, Location::Upload)?;
        Ok(Self {
            commands: CommandSet::new(context)?,
            top,
            view_buffer,
            adapts: true,
            rendered: false,
            budget: Budget::of(context.limits(), context.report().kind == DeviceKind::Software),
            drawn: None,
            sums: Sums::new(context)?,
            painter: None,
            planes: None,
            history: None,
            samples: None,
            lights: None,
            programs: Arc::clone(device.programs()),
            interface,
            context: Arc::clone(context),
            mode,
        })
    }

    /// Makes planes and tables fit for `inputs`, which will overwrite what was drawn; returns the constants with all addresses.
    pub(crate) fn prepare(&mut self, inputs: &Inputs<'_>) -> Result<layout::View> {
        self.drawn = None;
        let pixels = u64::from(inputs.size[0]) * u64::from(inputs.size[1]);
        if !self.planes.as_ref().is_some_and(|planes| planes.suits(pixels)) {
            // Freed before the new ones are made.
            self.planes = None;
            self.planes = Some(Planes::new(&self.context, pixels)?);
        }
        let mut view = constants::view(inputs.settings, inputs.view);
        view.size = inputs.size;
        view.count = inputs.count;
        self.planes().address(&mut view);
        let (directions, by_azimuth) = self.samples(inputs.settings)?;
        view.gather.directions = directions;
        view.gather.by_azimuth = by_azimuth;
        view.gather.lights = self.lights(inputs.view)?;
        Ok(view)
    }

    /// Begins a frame that continues the last one, or a sequence, if `settings` ask for that. `scene_moved` says whether the
    /// scene has since the last frame.
    pub(crate) fn begin(
        &mut self,
        inputs: &Inputs<'_>,
        scene_moved: bool,
        constants: &mut layout::View,
    ) -> Result<()> {
        let pixels = u64::from(inputs.count);
        let wanted = inputs.settings.temporal == Temporal::On;
        if !(wanted && self.history.as_ref().is_some_and(|history| history.suits(pixels))) {
            self.history = None;
        }
        if wanted {
            let history = match &mut self.history {
                Some(history) => history,
                none => none.insert(History::new(&self.context, pixels)?),
            };
            constants.temporal = history.begin(inputs.settings, inputs.view, scene_moved);
        }
        Ok(())
    }

    /// Ends a frame, all of which was rendered.
    pub(crate) fn end(&mut self, inputs: &Inputs<'_>) {
        self.rendered = true;
        if let Some(history) = &mut self.history {
            history.end(inputs.settings, inputs.view);
        }
    }

    /// Forgets earlier frames: the next one begins a sequence.
    pub(crate) fn forget_frames(&mut self) {
        if let Some(history) = &mut self.history {
            history.forget();
        }
    }

    /// What the last frame left, where light is accumulated.
    pub(crate) const fn history(&self) -> Option<&History> {
        self.history.as_ref()
    }

    /// Writes the constants of the next submissions.
    pub(crate) fn write_view(&mut self, view: &layout::View) {
        self.view_buffer.write(0, &[*view]);
    }

    /// The planes.
    ///
    /// # Panics
    /// Before [`prepare`](Self::prepare).
    pub(crate) fn planes(&self) -> &Planes {
        self.planes.as_ref().expect("prepared")
    }

    /// Programs for these constants.
    pub(crate) fn programs(&self, specialization: &Specialization) -> Result<Arc<Programs>> {
        self.programs.get(&self.interface, self.mode, specialization)
    }

    pub(crate) const fn interface(&self) -> &Arc<Interface> {
        &self.interface
    }

    fn samples(&mut self, settings: &Settings) -> Result<(u64, u64)> {
        if let Some((kept, directions, by_azimuth)) = &self.samples
            && *kept == sample_key(settings)
        {
            return Ok((directions.address(), by_azimuth.address()));
        }
        self.set_samples(settings, &SampleTables::of(settings))
    }

    /// Uploads `tables` as those of `settings`; returns their addresses.
    pub(crate) fn set_samples(&mut self, settings: &Settings, tables: &SampleTables) -> Result<(u64, u64)> {
        let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let directions = self.context.upload("sample directions", usage, &tables.directions)?;
        let by_azimuth = self.context.upload("samples by azimuth", usage, &tables.by_azimuth)?;
        let addresses = (directions.address(), by_azimuth.address());
        self.samples = Some((sample_key(settings), directions, by_azimuth));
        Ok(addresses)
    }

    fn lights(&mut self, view: &View) -> Result<u64> {
        let lights: Vec<_> = view.lights.iter().map(constants::light).collect();
        if let Some((kept, buffer)) = &self.lights
            && *kept == lights
        {
            return Ok(buffer.address());
        }
        let usage = BufferUsageFlags::STORAGE_BUFFER | BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        let buffer = self.context.upload("lights", usage, &lights)?;
        let address = buffer.address();
        self.lights = Some((lights, buffer));
        Ok(address)
    }
}
