//! Frames that stay on the device: drawn, shown as pictures, and read when the host wants them after all.

use std::{sync::Arc, time::Instant};

use ambray_core::{
    aov::Aov,
    control::Control,
    frame::{Frame, FrameStats, RayCounts},
    settings::Settings,
    view::View,
};

use crate::{
    Picture, Result, VulkanBackend, VulkanError,
    display::{self, Painter},
    layout, readback,
    state::State,
};

impl VulkanBackend {
    /// Renders a frame and leaves it on the device, for [`show`](Self::show) and [`read`](Self::read).
    pub fn draw(&self, settings: &Settings, view: &View, control: Control<'_>) -> Result<FrameStats> {
        let start = Instant::now();
        let mut state = self.state();
        let mut times = self.passes(&mut state, settings, view, control)?;
        let rays = self.count_rays(&mut state)?;
        times.total = start.elapsed();
        let stats = FrameStats { rays, times, threads: 0 };
        if let Some(drawn) = &mut state.drawn {
            drawn.stats = stats;
        }
        Ok(stats)
    }

    /// The plane `aov` of the last frame that was rendered or drawn, with the exposure, tone map, ramp and range of `settings`,
    /// as the picture that [`ambray_core::display`] makes of it on the host. It is finished when the call returns. The picture
    /// is the caller's until it is dropped; one that is given back is painted again.
    ///
    /// # Errors
    /// [`VulkanError::NothingDrawn`] before the first frame, after points were evaluated, and after a frame that failed or was
    /// cancelled.
    pub fn show(&self, aov: Aov, settings: &Settings) -> Result<Arc<Picture>> {
        let mut state = self.state();
        let State { drawn: Some(drawn), painter, view_buffer, commands, interface, .. } = &mut *state else {
            return Err(VulkanError::NothingDrawn);
        };
        let painter = match painter {
            Some(painter) => painter,
            none => none.insert(Painter::new(self.context())?),
        };
        let special = display::specialization(&drawn.settings);
        let programs = self.device().programs().display(interface, &special)?;
        let mut constants = drawn.constants;
        let picture = painter.prepare(aov, settings, constants.size, &mut constants)?;
        view_buffer.write(0, &[constants]);
        let view = view_buffer.address();
        commands.submit(|recorder| {
            painter.record(recorder, &programs, aov, view, &picture);
            Ok(())
        })?;
        commands.wait()?;
        Ok(picture)
    }

    /// Copies the last frame that was rendered or drawn to the host.
    ///
    /// # Errors
    /// As [`show`](Self::show).
    pub fn read(&self) -> Result<Frame> {
        let state = self.state();
        let Some(drawn) = &state.drawn else { return Err(VulkanError::NothingDrawn) };
        let mut frame = readback::frame(self.context(), &state, &drawn.settings, &drawn.view)?;
        frame.stats = drawn.stats;
        Ok(frame)
    }

    /// Rays of the frame that was drawn.
    fn count_rays(&self, state: &mut State) -> Result<RayCounts> {
        let State { drawn: Some(drawn), sums, view_buffer, commands, interface, .. } = state else {
            return Err(VulkanError::NothingDrawn);
        };
        let program = self.device().programs().sums(interface)?;
        let constants = layout::View { outputs: sums.address(), ..drawn.constants };
        view_buffer.write(0, &[constants]);
        let view = view_buffer.address();
        commands.submit(|recorder| {
            sums.record(recorder, &program, view, constants.count);
            Ok(())
        })?;
        commands.wait()?;
        Ok(sums.read(constants.count))
    }
}
