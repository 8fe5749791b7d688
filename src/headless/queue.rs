//! The queue, and command buffers that go to it one submission after another.
//!
//! ```text
//!   Submission:  start(|cmd| …) ─▶ in flight ─▶ finish ─▶ start(|cmd| …) ─▶ …
//! ```

use crate::gpu::{Commands, Device, GpuError, Named};
use ash::vk;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A device's queue. Vulkan lets one thread at a time use it (1.3, section 3.6, "Threading Behavior").
#[derive(Clone)]
pub(super) struct Queue(Arc<Mutex<vk::Queue>>);

impl Queue {
    /// The first queue of the family.
    ///
    /// # Safety
    /// The device was made with a queue of this family.
    pub(super) unsafe fn new(device: &ash::Device, family: u32) -> Self {
        // SAFETY: the caller's promise.
        Self(Arc::new(Mutex::new(unsafe { device.get_device_queue(family, 0) })))
    }

    fn lock(&self) -> MutexGuard<'_, vk::Queue> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

/// A command buffer with its fence, used again for each submission.
pub(super) struct Submission {
    device: Device,
    queue: Queue,
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    fence: vk::Fence,
    /// The last submission was not waited for.
    in_flight: bool,
}

impl Submission {
    /// For submissions to this queue of the device.
    pub(super) fn new(device: &Device, queue: &Queue) -> Result<Self, GpuError> {
        // Owned from here on, so that a failure frees what was made; destroying null is allowed.
        let mut this = Self {
            device: device.clone(),
            queue: queue.clone(),
            pool: vk::CommandPool::null(),
            commands: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            in_flight: false,
        };
        let raw = device.raw();
        let create = vk::CommandPoolCreateInfo::default().queue_family_index(device.queue_family());
        // SAFETY: the device is alive.
        this.pool = unsafe { raw.create_command_pool(&create, None) }.named("vkCreateCommandPool", "headless")?;
        let allocate = vk::CommandBufferAllocateInfo::default().command_pool(this.pool).command_buffer_count(1);
        // SAFETY: the pool was just made.
        this.commands =
            unsafe { raw.allocate_command_buffers(&allocate) }.named("vkAllocateCommandBuffers", "headless")?[0];
        // SAFETY: the device is alive.
        this.fence =
            unsafe { raw.create_fence(&vk::FenceCreateInfo::default(), None) }.named("vkCreateFence", "headless")?;
        Ok(this)
    }

    /// Waits for the submission before, records commands and submits them. If `record` returns an error, nothing is
    /// submitted.
    pub(super) fn start<R, E>(
        &mut self,
        record: impl FnOnce(&Commands<'_>) -> Result<R, E>,
    ) -> Result<Result<R, E>, GpuError> {
        self.finish()?;
        let raw = self.device.raw();
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the submission before has finished, so fence and pool may be reset.
        unsafe {
            raw.reset_fences(&[self.fence]).named("vkResetFences", "headless")?;
            raw.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty())
                .named("vkResetCommandPool", "headless")?;
            raw.begin_command_buffer(self.commands, &begin).named("vkBeginCommandBuffer", "headless")?;
        }
        // SAFETY: recording; the caller keeps what is recorded until `finish`.
        let result = record(&unsafe { Commands::new(&self.device, self.commands) });
        if result.is_err() {
            return Ok(result);
        }
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.commands)];
        let submit = vk::SubmitInfo2::default().command_buffer_infos(&commands);
        // SAFETY: recorded above; the lock keeps others away from the queue.
        unsafe {
            raw.end_command_buffer(self.commands).named("vkEndCommandBuffer", "headless")?;
            raw.queue_submit2(*self.queue.lock(), &[submit], self.fence).named("vkQueueSubmit2", "headless")?;
        }
        self.in_flight = true;
        Ok(result)
    }

    /// Waits until the GPU has finished the last submission. If that fails and the device is not lost, nothing that
    /// the GPU may use is freed.
    pub(super) fn finish(&mut self) -> Result<(), GpuError> {
        if !std::mem::take(&mut self.in_flight) || self.device.is_gone() {
            return Ok(());
        }
        let raw = self.device.raw();
        // SAFETY: the fence was submitted.
        let waited = match unsafe { raw.wait_for_fences(&[self.fence], true, u64::MAX) } {
            // The GPU is still running. Another way to wait may need less memory.
            Err(vk::Result::ERROR_OUT_OF_HOST_MEMORY | vk::Result::ERROR_OUT_OF_DEVICE_MEMORY) => {
                // SAFETY: the lock keeps others away from the queue.
                unsafe { raw.queue_wait_idle(*self.queue.lock()) }.named("vkQueueWaitIdle", "headless")
            }
            waited => waited.named("vkWaitForFences", "headless"),
        };
        waited.inspect_err(|error| {
            if !error.is_device_lost() {
                self.device.set_lost("vkQueueWaitIdle", "headless");
                self.device.abandon();
            }
        })
    }
}

impl Drop for Submission {
    fn drop(&mut self) {
        let _ = self.finish(); // after a panic it is in flight; an error leaves nothing more to do
        if self.device.is_gone() {
            return;
        }
        // SAFETY: owned here; every submission has finished, or the device is lost.
        unsafe {
            self.device.raw().destroy_fence(self.fence, None);
            self.device.raw().destroy_command_pool(self.pool, None);
        }
    }
}
