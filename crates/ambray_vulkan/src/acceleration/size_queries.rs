//! The size that structures need once they are built.

use ash::vk;

use crate::Context;
use crate::error::{Result, VulkanError};

/// Asks structures for the size they need.
pub(super) struct SizeQueries<'c> {
    context: &'c Context,
    pool: vk::QueryPool,
    count: u32,
}

impl<'c> SizeQueries<'c> {
    const KIND: vk::QueryType = vk::QueryType::ACCELERATION_STRUCTURE_COMPACTED_SIZE_KHR;

    pub(super) fn new(context: &'c Context, count: u32) -> Result<Self> {
        let info = vk::QueryPoolCreateInfo::default().query_type(Self::KIND).query_count(count.max(1));
        // SAFETY: the device is alive; the pool is destroyed when dropped.
        let pool = unsafe { context.device.create_query_pool(&info, None) }
            .map_err(VulkanError::of("vkCreateQueryPool"))?;
        Ok(Self { context, pool, count })
    }

    pub(super) fn record(&self, buffer: vk::CommandBuffer, structures: &[vk::AccelerationStructureKHR]) {
        assert_eq!(structures.len(), self.count as usize);
        if self.count == 0 {
            return;
        }
        // SAFETY: the buffer is being recorded, the pool has a query for each structure, and all are built with the flag
        // for it, with a barrier behind.
        unsafe {
            self.context.device.cmd_reset_query_pool(buffer, self.pool, 0, self.count);
            self.context.acceleration.cmd_write_acceleration_structures_properties(
                buffer,
                structures,
                Self::KIND,
                self.pool,
                0,
            );
        }
    }

    /// The answers, once the commands have run.
    pub(super) fn read(&self) -> Result<Vec<u64>> {
        let mut sizes = vec![0_u64; self.count as usize];
        if self.count > 0 {
            let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
            // SAFETY: the queries were written by commands that have run.
            unsafe { self.context.device.get_query_pool_results(self.pool, 0, &mut sizes, flags) }
                .map_err(VulkanError::of("vkGetQueryPoolResults"))?;
        }
        Ok(sizes)
    }
}

impl Drop for SizeQueries<'_> {
    fn drop(&mut self) {
        // SAFETY: commands that used the pool have run: recording and waiting is one call.
        unsafe { self.context.device.destroy_query_pool(self.pool, None) };
    }
}
