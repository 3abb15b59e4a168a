//! Commands for the device: recording, ordering, submitting, waiting and timing.

mod work;

use std::marker::PhantomData;
use std::sync::Arc;
use std::time::Duration;

use ash::vk;

pub use self::work::Work;
use crate::error::{Result, VulkanError};
use crate::{Buffer, Context};

/// Most timestamps of a submission, the one at its start included.
const STAMPS: u32 = 64;

/// Time between two consecutive timestamps of a submission.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Timing {
    /// What was done in that time.
    pub label: &'static str,
    /// How long it took on the device; `None` where the queue has no timestamps.
    pub duration: Option<Duration>,
}

/// A command buffer with what is needed to submit it and wait for it, to be used again and again.
#[derive(Debug)]
pub struct CommandSet {
    raw: RawSet,
    labels: Vec<&'static str>,
    /// Whether a submission has not been waited for.
    is_pending: bool,
}

/// A command buffer that is being recorded.
#[derive(Debug)]
pub struct Recorder<'a> {
    context: &'a Context,
    buffer: vk::CommandBuffer,
    queries: vk::QueryPool,
    labels: Vec<&'static str>,
    /// One thread records.
    _not_sync: PhantomData<*const ()>,
}

impl Context {
    /// Records commands with `record`, runs them, and waits. If `record` fails, nothing runs.
    pub fn run<T>(self: &Arc<Self>, record: impl FnOnce(&mut Recorder<'_>) -> Result<T>) -> Result<T> {
        let mut commands = CommandSet::new(self)?;
        let value = commands.submit(record)?;
        commands.wait()?;
        Ok(value)
    }
}

impl CommandSet {
    /// Makes a set that has nothing to wait for.
    pub fn new(context: &Arc<Context>) -> Result<Self> {
        Ok(Self { raw: RawSet::new(context)?, labels: Vec::new(), is_pending: false })
    }

    /// Waits for the last submission, then records commands with `record` and submits them. If `record` fails, nothing is
    /// submitted. What the commands use must live until [`wait`](Self::wait) returns, or this call of the next round.
    pub fn submit<T>(&mut self, record: impl FnOnce(&mut Recorder<'_>) -> Result<T>) -> Result<T> {
        self.submit_between(None, None, record)
    }

    /// As [`submit`](Self::submit): the first semaphore is waited for before colours are written, the second is signalled when
    /// all is done. Both must be of this device, and stay until the submission is through.
    pub(crate) fn submit_between<T>(
        &mut self,
        before: Option<vk::Semaphore>,
        after: Option<vk::Semaphore>,
        record: impl FnOnce(&mut Recorder<'_>) -> Result<T>,
    ) -> Result<T> {
        self.finish()?;
        let RawSet { ref context, pool, buffer, fence, queries } = self.raw;
        let device = &context.device;
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: pool and buffer are ours alone (`&mut self`), and the device is done with them, as was just waited for.
        unsafe {
            device
                .reset_command_pool(pool, vk::CommandPoolResetFlags::empty())
                .map_err(VulkanError::of("vkResetCommandPool"))?;
            device.begin_command_buffer(buffer, &begin).map_err(VulkanError::of("vkBeginCommandBuffer"))?;
            if queries != vk::QueryPool::null() {
                device.cmd_reset_query_pool(buffer, queries, 0, STAMPS);
            }
        }
        self.labels.clear();
        let labels = std::mem::take(&mut self.labels);
        let mut recorder = Recorder { context, buffer, queries, labels, _not_sync: PhantomData };
        recorder.stamp("");
        let value = record(&mut recorder)?;
        self.labels = recorder.labels;
        let buffers = [buffer];
        let stages = [vk::PipelineStageFlags::COLOR_ATTACHMENT_OUTPUT];
        let submits = [vk::SubmitInfo::default()
            .wait_semaphores(before.as_slice())
            .wait_dst_stage_mask(&stages[..before.as_slice().len()])
            .signal_semaphores(after.as_slice())
            .command_buffers(&buffers)];
        // SAFETY: the buffer is being recorded and ends here; the fence is not in use, as was waited for; the semaphores are
        // alive, as the caller promises; the queue is locked while it takes the submission.
        unsafe {
            device.end_command_buffer(buffer).map_err(VulkanError::of("vkEndCommandBuffer"))?;
            device.reset_fences(&[fence]).map_err(VulkanError::of("vkResetFences"))?;
            device
                .queue_submit(*context.queue(), &submits, fence)
                .map_err(VulkanError::of("vkQueueSubmit"))?;
        }
        self.is_pending = true;
        Ok(value)
    }

    /// Waits for the last submission, and says how long its parts took on the device.
    pub fn wait(&mut self) -> Result<Vec<Timing>> {
        self.finish()?;
        let labels = self.labels.get(1..).unwrap_or_default();
        let stamps = self.raw.stamps(self.labels.len())?;
        let limits = self.raw.context.limits();
        let duration = |i: usize| {
            let (from, to) = (*stamps.get(i)?, *stamps.get(i + 1)?);
            // Counters of fewer than 64 bits wrap around.
            let ticks = to.wrapping_sub(from) & (u64::MAX >> (64 - limits.timestamp_bits.clamp(1, 64)));
            Some(Duration::from_nanos((ticks as f64 * f64::from(limits.timestamp_period)) as u64))
        };
        Ok(labels.iter().enumerate().map(|(i, &label)| Timing { label, duration: duration(i) }).collect())
    }

    /// Whether the last submission is through, without waiting.
    pub fn is_done(&self) -> Result<bool> {
        if !self.is_pending {
            return Ok(true);
        }
        // SAFETY: the fence is ours and alive.
        unsafe { self.raw.context.device.get_fence_status(self.raw.fence) }
            .map_err(VulkanError::of("vkGetFenceStatus"))
    }

    fn finish(&mut self) -> Result<()> {
        if !self.is_pending {
            return Ok(());
        }
        // SAFETY: the fence is ours, and was given to a submission.
        let waited = unsafe { self.raw.context.device.wait_for_fences(&[self.raw.fence], true, u64::MAX) };
        // Anything but success and a lost device leaves the commands running: they stay pending.
        self.is_pending = !matches!(waited, Ok(()) | Err(vk::Result::ERROR_DEVICE_LOST));
        waited.map_err(VulkanError::of("vkWaitForFences"))
    }
}

impl Drop for CommandSet {
    fn drop(&mut self) {
        // Only a lost device fails here, and it uses nothing any more.
        let _ = self.finish();
    }
}

impl Recorder<'_> {
    /// The command buffer, to record what has no method here.
    #[must_use]
    pub const fn raw(&self) -> vk::CommandBuffer {
        self.buffer
    }

    /// The context that the commands are for.
    #[must_use]
    pub const fn context(&self) -> &Context {
        self.context
    }

    /// Lets all `after` that follows wait for all `before` so far, and see what it wrote.
    ///
    /// Every ordering of this crate goes through here, by the names of the work: validation layers see no hazards around
    /// traced rays, and software devices run commands in order, so a wrong mask would show on graphics cards only. The
    /// barriers are global, since nothing here gains from naming single buffers.
    pub fn barrier(&mut self, before: Work, after: Work) {
        let (pipelines, queries) = (self.context.has_pipelines(), self.context.has_queries());
        let (from, wrote) = before.mask(pipelines, queries);
        let (to, touches) = after.mask(pipelines, queries);
        let barriers = [vk::MemoryBarrier::default().src_access_mask(wrote).dst_access_mask(touches)];
        // SAFETY: the buffer is being recorded, outside of render passes, and the masks name only stages and accesses of
        // features that the device was opened with.
        unsafe {
            self.context.device.cmd_pipeline_barrier(
                self.buffer,
                from,
                to,
                vk::DependencyFlags::empty(),
                &barriers,
                &[],
                &[],
            );
        }
    }

    /// Copies `size` bytes between buffers that have the usages for it.
    ///
    /// # Panics
    /// If the range is not within both.
    pub fn copy(&mut self, from: &Buffer, from_offset: u64, to: &Buffer, to_offset: u64, size: u64) {
        let within =
            |buffer: &Buffer, offset: u64| offset.checked_add(size).is_some_and(|end| end <= buffer.size());
        assert!(
            within(from, from_offset) && within(to, to_offset),
            "copy of {size} bytes from '{}' to '{}'",
            from.name(),
            to.name()
        );
        if size == 0 {
            return;
        }
        let region = vk::BufferCopy { src_offset: from_offset, dst_offset: to_offset, size };
        // SAFETY: both buffers are alive, and the region is within them.
        unsafe {
            self.context.device.cmd_copy_buffer(self.buffer, from.handle(), to.handle(), &[region]);
        }
    }

    /// Fills a buffer that has the usage `TRANSFER_DST` with copies of `word`, up to the last whole word.
    pub fn fill(&mut self, buffer: &Buffer, word: u32) {
        let size = buffer.size() & !3;
        if size > 0 {
            // SAFETY: the buffer is alive, and the range is whole words within it.
            unsafe { self.context.device.cmd_fill_buffer(self.buffer, buffer.handle(), 0, size, word) };
        }
    }

    /// Ends a part of the work: [`CommandSet::wait`] tells the time from the last call, or the start, to this one. Parts
    /// beyond the 63rd are not told.
    pub fn timestamp(&mut self, label: &'static str) {
        self.stamp(label);
    }

    fn stamp(&mut self, label: &'static str) {
        let index = self.labels.len() as u32;
        if index >= STAMPS {
            return;
        }
        self.labels.push(label);
        if self.queries != vk::QueryPool::null() {
            let stage = vk::PipelineStageFlags::BOTTOM_OF_PIPE;
            // SAFETY: the pool has been reset in this buffer, and each of its queries is written once.
            unsafe { self.context.device.cmd_write_timestamp(self.buffer, stage, self.queries, index) };
        }
    }
}

/// Handles of a [`CommandSet`]; null where they were not made.
#[derive(Debug)]
struct RawSet {
    context: Arc<Context>,
    pool: vk::CommandPool,
    buffer: vk::CommandBuffer,
    fence: vk::Fence,
    queries: vk::QueryPool,
}

impl RawSet {
    fn new(context: &Arc<Context>) -> Result<Self> {
        let device = &context.device;
        let mut set = Self {
            context: Arc::clone(context),
            pool: vk::CommandPool::null(),
            buffer: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            queries: vk::QueryPool::null(),
        };
        let pool = vk::CommandPoolCreateInfo::default().queue_family_index(context.queue_family());
        let queries =
            vk::QueryPoolCreateInfo::default().query_type(vk::QueryType::TIMESTAMP).query_count(STAMPS);
        // SAFETY: the device is alive as long as the context that the set holds; what is made here is destroyed by
        // dropping the set, also when a later call fails.
        unsafe {
            set.pool =
                device.create_command_pool(&pool, None).map_err(VulkanError::of("vkCreateCommandPool"))?;
            let buffers = vk::CommandBufferAllocateInfo::default()
                .command_pool(set.pool)
                .level(vk::CommandBufferLevel::PRIMARY)
                .command_buffer_count(1);
            set.buffer = device
                .allocate_command_buffers(&buffers)
                .map_err(VulkanError::of("vkAllocateCommandBuffers"))?[0];
            set.fence = device
                .create_fence(&vk::FenceCreateInfo::default(), None)
                .map_err(VulkanError::of("vkCreateFence"))?;
            if context.limits().timestamp_bits > 0 {
                set.queries =
                    device.create_query_pool(&queries, None).map_err(VulkanError::of("vkCreateQueryPool"))?;
            }
        }
        Ok(set)
    }

    /// The first `count` timestamps of a submission that is through; none where the queue has none.
    fn stamps(&self, count: usize) -> Result<Vec<u64>> {
        if self.queries == vk::QueryPool::null() || count == 0 {
            return Ok(Vec::new());
        }
        let mut stamps = vec![0_u64; count];
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        // SAFETY: these queries were written by a submission that is through.
        unsafe { self.context.device.get_query_pool_results(self.queries, 0, &mut stamps, flags) }
            .map_err(VulkanError::of("vkGetQueryPoolResults"))?;
        Ok(stamps)
    }
}

impl Drop for RawSet {
    fn drop(&mut self) {
        let device = &self.context.device;
        // SAFETY: the handles are ours or null, and the set that owned them has waited for the device.
        unsafe {
            device.destroy_query_pool(self.queries, None);
            device.destroy_fence(self.fence, None);
            device.destroy_command_pool(self.pool, None);
        }
    }
}
