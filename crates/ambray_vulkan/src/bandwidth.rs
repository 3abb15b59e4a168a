//! How fast the device's memory is, measured: what the times of passes are compared with.

use ash::vk::BufferUsageFlags;

use crate::{CommandSet, DeviceKind, Location, Result, VulkanBackend, Work};

/// Bytes copied at once: several times the caches of graphics cards.
const SIZE: u64 = 512 << 20;
/// The same for devices that are really the processor.
const SOFTWARE_SIZE: u64 = 64 << 20;
/// Copies that are timed, after one that is not.
const ROUNDS: usize = 10;

impl VulkanBackend {
    /// Bytes a second that a large copy within the device's memory reads and writes, both counted; the fastest of several
    /// copies. `None` where the device has no clock.
    pub fn copy_bandwidth(&self) -> Result<Option<f64>> {
        let context = self.context();
        let limits = context.limits();
        let most = if context.report().kind == DeviceKind::Software { SOFTWARE_SIZE } else { SIZE };
        let size = most.min(limits.allocation).min(limits.heap / 8);
        let buffer = |name, usage| context.buffer(name, size, usage, Location::Device);
        let from =
            buffer("source of a copy", BufferUsageFlags::TRANSFER_SRC | BufferUsageFlags::TRANSFER_DST)?;
        let to = buffer("target of a copy", BufferUsageFlags::TRANSFER_DST)?;
        let mut commands = CommandSet::new(context)?;
        commands.submit(|recorder| {
            // Memory that was never written may cost nothing to read.
            recorder.fill(&from, 0x5eed);
            for _ in 0..=ROUNDS {
                recorder.barrier(Work::Transfer, Work::Transfer);
                recorder.timestamp("between");
                recorder.copy(&from, 0, &to, 0, size);
                recorder.timestamp(COPY);
            }
            Ok(())
        })?;
        let timings = commands.wait()?;
        let copies = timings.iter().filter(|timing| timing.label == COPY).skip(1);
        let fastest = copies.filter_map(|timing| timing.duration).filter(|time| !time.is_zero()).min();
        Ok(fastest.map(|time| 2.0 * size as f64 / time.as_secs_f64()))
    }
}

const COPY: &str = "copy";
