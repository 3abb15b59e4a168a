//! The shader binding table: handles of shader groups in device memory, aligned as the device wants them.

use std::sync::Arc;

use ash::vk;

use crate::{Buffer, Context, Location, Result};

/// Handles in four regions: ray generation, miss, hit, callable.
#[derive(Debug)]
pub(super) struct ShaderTable {
    _buffer: Buffer,
    /// Regions in that order; of ray generation, the first shader's.
    regions: [vk::StridedDeviceAddressRegionKHR; 4],
}

/// Where handles go: offsets from the aligned start of the table, in bytes.
#[derive(Debug, PartialEq, Eq)]
struct Places {
    /// Offset of each region.
    starts: [u64; 4],
    /// Distance of the records of each region.
    strides: [u64; 4],
    size: u64,
}

impl Places {
    /// Each ray generation shader is a region of its own to the device, so it begins where a region may.
    fn new(counts: [u32; 4], handle_size: u64, handle_alignment: u64, base_alignment: u64) -> Self {
        let stride = handle_size.next_multiple_of(handle_alignment);
        let strides = [stride.next_multiple_of(base_alignment), stride, stride, stride];
        let mut size = 0;
        let starts = std::array::from_fn(|region| {
            let start = size;
            size = (start + u64::from(counts[region]) * strides[region]).next_multiple_of(base_alignment);
            start
        });
        Self { starts, strides, size }
    }
}

impl ShaderTable {
    /// A table of `counts` handles a region, which follow each other in `handles`.
    pub(super) fn new(context: &Arc<Context>, handles: &[u8], counts: [u32; 4]) -> Result<Self> {
        let limits = context.limits();
        let [handle_size, handle_alignment, base] =
            [limits.group_handle_size, limits.group_handle_alignment, limits.group_base_alignment]
                .map(u64::from);
        let places = Places::new(counts, handle_size, handle_alignment, base);
        let usage =
            vk::BufferUsageFlags::SHADER_BINDING_TABLE_KHR | vk::BufferUsageFlags::SHADER_DEVICE_ADDRESS;
        // Addresses of buffers may be aligned less than a table must be.
        let bytes = places.size + base;
        let mut buffer = context.buffer("shader binding table", bytes, usage, Location::Upload)?;
        let start = buffer.address().next_multiple_of(base);
        let records = (0..4).flat_map(|region| (0..u64::from(counts[region])).map(move |i| (region, i)));
        for ((region, i), handle) in records.zip(handles.chunks_exact(handle_size as usize)) {
            let at = places.starts[region] + i * places.strides[region];
            buffer.write(start - buffer.address() + at, handle);
        }
        let region = |i: usize| vk::StridedDeviceAddressRegionKHR {
            device_address: start + places.starts[i],
            stride: places.strides[i],
            size: if i == 0 { places.strides[0] } else { u64::from(counts[i]) * places.strides[i] },
        };
        Ok(Self { _buffer: buffer, regions: [0, 1, 2, 3].map(region) })
    }

    /// Regions with the ray generation shader `raygen`.
    pub(super) fn regions(&self, raygen: u32) -> [vk::StridedDeviceAddressRegionKHR; 4] {
        let mut regions = self.regions;
        regions[0].device_address += u64::from(raygen) * regions[0].stride;
        regions
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn regions_are_aligned_and_apart() {
        for (handle, alignment, base) in [(32, 32, 64), (32, 16, 64), (16, 64, 256), (48, 32, 64)] {
            let counts = [4, 4, 12, 4];
            let Places { starts, strides, size } = Places::new(counts, handle, alignment, base);
            for i in 0..4 {
                assert_eq!(starts[i] % base, 0);
                assert_eq!(strides[i] % alignment, 0);
                assert!(strides[i] >= handle);
                let end = starts[i] + u64::from(counts[i]) * strides[i];
                assert!(end <= starts.get(i + 1).copied().unwrap_or(size));
            }
            assert_eq!(strides[0] % base, 0, "each ray generation shader is a region");
        }
    }
}
