//! Instance, device and queue without a window: the host's part, for tools, tests and the command line.
//!
//! ```text
//!   HeadlessDevice::new ── loader ─ instance (+ validation) ─ device ─ allocator ─ queue
//!          │ submit(|cmd| …)   records, submits, waits
//!          ▼ drop              queue ─ allocator ─ device ─ messenger ─ instance
//! ```
//!
//! Everything made from [`HeadlessDevice::device`] is dropped before it. [`HeadlessDevice::shutdown`] names what is still
//! alive, and the leaks that the validation layers find.

mod instance;
mod messages;
mod renderer;
mod sequence;
#[cfg(test)]
mod tests;

pub use messages::{Message, Severity};
pub use renderer::HeadlessRenderer;
pub use sequence::PictureView;

use crate::gpu::{Commands, Device, GpuError, HostDevice, LowerLimits, Named, Requirements};
use ash::vk;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use instance::Instance;
use messages::Messages;
use std::mem::ManuallyDrop;
use std::sync::{Arc, Mutex, PoisonError};

/// Which device, and how closely it is watched.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HeadlessOptions {
    /// Part of the device's name, in any case; `None` takes a discrete GPU, else an integrated one,
    /// else the CPU.
    pub device: Option<String>,
    /// Validation and synchronisation validation, collected in [`HeadlessDevice::messages`].
    pub validation: bool,
}

/// Why there is no device.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum HeadlessError {
    /// The system has no Vulkan loader.
    #[error("no Vulkan loader on this system (on Debian: apt install libvulkan1 mesa-vulkan-drivers): {source}")]
    NoLoader {
        /// The dynamic linker's reason.
        source: ash::LoadingError,
    },
    /// The loader found no driver.
    #[error("no Vulkan device on this system (on Debian: apt install mesa-vulkan-drivers)")]
    NoDevice,
    /// No device of the wanted name.
    #[error("no Vulkan device is named like `{wanted}`; there are: {present}")]
    NoSuchDevice {
        /// The name in the options.
        wanted: String,
        /// Names of the devices found.
        present: String,
    },
    /// Devices, but none that the engine runs on.
    #[error("no Vulkan device suffices: {devices}")]
    Lacking {
        /// Each device with what it lacks.
        devices: String,
    },
    /// The options want validation, and its layer is not installed.
    #[error("the Vulkan validation layers are not installed (on Debian: apt install vulkan-validationlayers)")]
    NoValidation,
    /// The allocator could not be made.
    #[error("no memory allocator for this device: {source}")]
    Allocator {
        /// Its reason.
        source: gpu_allocator::AllocationError,
    },
    /// A frame's buffers were still too small after they had grown several times.
    #[error("the frame did not fit its buffers even after they had grown several times")]
    NeverComplete,
    /// A frame could not be recorded.
    #[error(transparent)]
    Render(#[from] crate::renderer::RenderError),
    /// A Vulkan call failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

/// A device of our own, without a window.
pub struct HeadlessDevice {
    parts: ManuallyDrop<Parts>,
    messages: Messages,
}

/// Dropped in this order.
struct Parts {
    queue: Mutex<Queue>,
    device: Device,
    _allocator: Arc<Mutex<Allocator>>,
    _owned: OwnedDevice,
    _instance: Instance,
}

impl HeadlessDevice {
    /// Loads Vulkan and makes a device that meets [`Requirements`].
    ///
    /// # Errors
    /// [`HeadlessError`], each with what to install or choose.
    pub fn new(options: &HeadlessOptions) -> Result<Self, HeadlessError> {
        Self::limited(options, LowerLimits::NONE)
    }

    /// As [`new`](Self::new), with lower limits.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    #[doc(hidden)]
    pub fn limited(options: &HeadlessOptions, lower: LowerLimits) -> Result<Self, HeadlessError> {
        let instance = Instance::new(options)?;
        let physical = instance.choose(options.device.as_deref())?;
        let messages = instance.messages.clone();

        let (mut core, mut v12, mut v13) = Default::default();
        Requirements::add_to(&mut core, &mut v12, &mut v13);
        // SAFETY: the device belongs to the instance.
        let offered = unsafe { instance.raw.get_physical_device_features(physical) };
        core.pipeline_statistics_query = offered.pipeline_statistics_query;
        // SAFETY: as above.
        let family = unsafe { Requirements::queue_family(&instance.raw, physical) };
        let Some(queue_family) = family else { return Err(HeadlessError::NoDevice) };
        let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(queue_family).queue_priorities(&[1.0])];
        let extensions: Vec<_> = Requirements::DEVICE_EXTENSIONS.iter().map(|name| name.as_ptr()).collect();
        let create = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions)
            .enabled_features(&core)
            .push_next(&mut v12)
            .push_next(&mut v13);
        // SAFETY: what the chain points to outlives the call.
        let raw = unsafe { instance.raw.create_device(physical, &create, None) }.named("vkCreateDevice", "device")?;
        let owned = OwnedDevice(raw.clone());

        let description = AllocatorCreateDesc {
            instance: instance.raw.clone(),
            device: raw.clone(),
            physical_device: physical,
            debug_settings: Default::default(),
            buffer_device_address: false,
            allocation_sizes: Default::default(),
        };
        let allocator = Allocator::new(&description).map_err(|source| HeadlessError::Allocator { source })?;
        let allocator = Arc::new(Mutex::new(allocator));
        let host = HostDevice {
            instance: &instance.raw,
            physical,
            device: raw.clone(),
            queue_family,
            allocator: allocator.clone(),
            debug_names: instance.debug_utils,
            pipeline_statistics: core.pipeline_statistics_query == vk::TRUE,
        };
        // SAFETY: made above with the requirements; `Parts` and `Drop` keep it until the last user is gone.
        let device = unsafe { Device::limited(host, lower) };
        let queue = Mutex::new(Queue::new(raw, queue_family)?);
        let parts = Parts { queue, device, _allocator: allocator, _owned: owned, _instance: instance };
        Ok(Self { parts: ManuallyDrop::new(parts), messages })
    }

    /// The device, for the engine.
    pub fn device(&self) -> &Device {
        &self.parts.device
    }

    /// Records commands, submits them, and waits until the GPU has finished.
    ///
    /// Nothing that `record` uses may be dropped within it: return staging buffers from it.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`].
    pub fn submit<R>(&self, record: impl FnOnce(&Commands<'_>) -> R) -> Result<R, GpuError> {
        let recorded = self.try_submit(|cmd| Ok::<R, std::convert::Infallible>(record(cmd)))?;
        let Ok(result) = recorded;
        Ok(result)
    }

    /// As [`submit`](Self::submit), but what ends in an error is forgotten instead of submitted.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`]; inside, what `record` returned.
    pub fn try_submit<R, E>(
        &self,
        record: impl FnOnce(&Commands<'_>) -> Result<R, E>,
    ) -> Result<Result<R, E>, GpuError> {
        let mut queue = self.parts.queue.lock().unwrap_or_else(PoisonError::into_inner);
        let recorded = queue.start(&self.parts.device, record)?;
        queue.finish()?;
        Ok(recorded)
    }

    /// The same queue with a command buffer of its own. One thread submits by both.
    fn another_queue(&self) -> Result<Queue, GpuError> {
        Queue::new(self.parts.device.raw().clone(), self.parts.device.queue_family())
    }

    /// What the validation layers have said so far, oldest first.
    pub fn messages(&self) -> Vec<Message> {
        self.messages.all()
    }

    /// The messages so far, which are then forgotten.
    pub fn take_messages(&self) -> Vec<Message> {
        self.messages.take()
    }

    /// Destroys the device and returns every message, those about leaks included.
    pub fn shutdown(self) -> Vec<Message> {
        let messages = self.messages.clone();
        drop(self);
        messages.take()
    }
}

impl Drop for HeadlessDevice {
    fn drop(&mut self) {
        if self.parts.device.is_last() {
            // SAFETY: dropped once, here; nothing made from the device lives.
            unsafe { ManuallyDrop::drop(&mut self.parts) };
            return;
        }
        // Whatever lives may still be used and will free itself: the device must stay for it.
        let text = format!("alive after their device: {}", self.parts.device.objects().join(", "));
        self.messages.push(Message { severity: Severity::Error, id: "selvedge-leak".to_owned(), text });
    }
}

/// A device to be destroyed.
struct OwnedDevice(ash::Device);

impl Drop for OwnedDevice {
    fn drop(&mut self) {
        // SAFETY: declared after everything made from it.
        unsafe { self.0.destroy_device(None) }
    }
}

/// The queue with one command buffer, used again for each submission.
struct Queue {
    device: ash::Device,
    queue: vk::Queue,
    pool: vk::CommandPool,
    commands: vk::CommandBuffer,
    fence: vk::Fence,
    /// What was submitted last has not been waited for.
    in_flight: bool,
}

impl Queue {
    fn new(device: ash::Device, family: u32) -> Result<Self, GpuError> {
        // SAFETY: the device was made with one queue of this family.
        let queue = unsafe { device.get_device_queue(family, 0) };
        // Owned from here on, so that a failure frees what was made; destroying null is allowed.
        let mut this = Self {
            device,
            queue,
            pool: vk::CommandPool::null(),
            commands: vk::CommandBuffer::null(),
            fence: vk::Fence::null(),
            in_flight: false,
        };
        let create = vk::CommandPoolCreateInfo::default().queue_family_index(family);
        // SAFETY: the device is alive.
        this.pool =
            unsafe { this.device.create_command_pool(&create, None) }.named("vkCreateCommandPool", "headless")?;
        let allocate = vk::CommandBufferAllocateInfo::default().command_pool(this.pool).command_buffer_count(1);
        // SAFETY: the pool was just made.
        this.commands = unsafe { this.device.allocate_command_buffers(&allocate) }
            .named("vkAllocateCommandBuffers", "headless")?[0];
        // SAFETY: the device is alive.
        this.fence = unsafe { this.device.create_fence(&vk::FenceCreateInfo::default(), None) }
            .named("vkCreateFence", "headless")?;
        Ok(this)
    }

    /// Records commands and submits them; what ends in an error is forgotten instead.
    fn start<R, E>(
        &mut self,
        device: &Device,
        record: impl FnOnce(&Commands<'_>) -> Result<R, E>,
    ) -> Result<Result<R, E>, GpuError> {
        self.finish()?;
        let raw = &self.device;
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the submission before has finished, so the pool may be reset; the lock keeps others away.
        unsafe {
            raw.reset_command_pool(self.pool, vk::CommandPoolResetFlags::empty())
                .named("vkResetCommandPool", "headless")?;
            raw.begin_command_buffer(self.commands, &begin).named("vkBeginCommandBuffer", "headless")?;
        }
        // SAFETY: recording; it is waited for before anything recorded can be dropped.
        let result = record(&unsafe { Commands::new(device, self.commands) });
        if result.is_err() {
            return Ok(result);
        }
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.commands)];
        let submit = vk::SubmitInfo2::default().command_buffer_infos(&commands);
        // SAFETY: recorded above; queue and fence are ours alone.
        unsafe {
            raw.end_command_buffer(self.commands).named("vkEndCommandBuffer", "headless")?;
            raw.queue_submit2(self.queue, &[submit], self.fence).named("vkQueueSubmit2", "headless")?;
        }
        self.in_flight = true;
        Ok(result)
    }

    /// Waits for what was submitted last.
    fn finish(&mut self) -> Result<(), GpuError> {
        if std::mem::take(&mut self.in_flight) {
            // SAFETY: submitted with this fence, which is ours alone.
            unsafe {
                self.device.wait_for_fences(&[self.fence], true, u64::MAX).named("vkWaitForFences", "headless")?;
                self.device.reset_fences(&[self.fence]).named("vkResetFences", "headless")?;
            }
        }
        Ok(())
    }
}

impl Drop for Queue {
    fn drop(&mut self) {
        // on the way out of an error frames may be in flight; without a device there is nothing to wait for
        let _ = self.finish();
        // SAFETY: every submission was waited for.
        unsafe {
            self.device.destroy_fence(self.fence, None);
            self.device.destroy_command_pool(self.pool, None);
        }
    }
}
