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

mod devices;
mod images;
mod instance;
mod loader;
mod messages;
mod pipelines;
mod queue;
mod renderer;
mod sequence;
#[cfg(test)]
mod tests;

pub use devices::{DeviceLimits, DeviceSummary, devices};
pub use images::PictureView;
pub use messages::{Message, Severity};
pub use renderer::{HeadlessRenderer, Watch};

use crate::gpu::{BlockAllocator, Commands, Device, GpuError, HostDevice, LowerLimits, Named, Requirements};
use crate::gpu::{SharedPipeline, lock};
use ash::vk;
use instance::Instance;
use messages::Messages;
use pipelines::PipelineFile;
use queue::{Queue, Submission};
use std::io;
use std::mem::ManuallyDrop;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// Which device, and how closely it is watched.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HeadlessOptions {
    /// Part of the device's name, in any case; `None` takes a discrete GPU, else an integrated one, else the CPU. Of
    /// several devices it is the first, and with `#1` behind it the second: `#1` alone is the second of all that the
    /// engine runs on, in the order of [`devices()`].
    pub device: Option<String>,
    /// Validation and synchronisation validation, collected in [`HeadlessDevice::messages`].
    pub validation: bool,
    /// The folder that keeps compiled pipelines from one run to the next, in a file for each device and driver; `None`:
    /// none are kept. A file that is damaged or of another device is ignored.
    pub pipeline_folder: Option<PathBuf>,
    /// Most bytes of the engine's buffers and images: [`HostDevice::memory_budget`]. `None`: what the heaps have left.
    pub memory_budget: Option<u64>,
}

/// Why there is no device, or no picture.
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
    /// A frame's buffers were still too small after they had grown several times.
    #[error("the frame did not fit its buffers even after they had grown several times")]
    NeverComplete,
    /// A model was not uploaded, or a frame not recorded.
    #[error(transparent)]
    Render(#[from] crate::renderer::RenderError),
    /// A Vulkan call failed.
    #[error(transparent)]
    Gpu(#[from] GpuError),
}

impl HeadlessError {
    /// The error of Vulkan or of memory within.
    pub fn gpu(&self) -> Option<&GpuError> {
        match self {
            Self::Gpu(error) => Some(error),
            Self::Render(error) => error.gpu(),
            _ => None,
        }
    }
}

/// A device of our own, without a window.
pub struct HeadlessDevice {
    /// Of [`keep_pipelines`](Self::keep_pipelines); they go before the device.
    kept: Mutex<Vec<SharedPipeline>>,
    parts: ManuallyDrop<Parts>,
    messages: Messages,
}

/// Dropped in this order.
struct Parts {
    queue: Queue,
    /// With the allocator.
    device: Device,
    cache: Option<Cache>,
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
        Self::of_entry(loader::load()?, options, lower)
    }

    /// As [`limited`](Self::limited), on another Vulkan loader than the system's: tests pass a double of the driver.
    ///
    /// # Errors
    /// As [`new`](Self::new).
    #[doc(hidden)]
    pub fn of_entry(entry: ash::Entry, options: &HeadlessOptions, lower: LowerLimits) -> Result<Self, HeadlessError> {
        let instance = Instance::new(entry, options)?;
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
        let mut extensions: Vec<_> = Requirements::DEVICE_EXTENSIONS.iter().map(|name| name.as_ptr()).collect();
        // a device with this extension must have it enabled (VUID-VkDeviceCreateInfo-pProperties-04451)
        extensions.extend(instance.is_portable(physical).then_some(ash::khr::portability_subset::NAME.as_ptr()));
        let create = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions)
            .enabled_features(&core)
            .push_next(&mut v12)
            .push_next(&mut v13);
        // SAFETY: what the chain points to outlives the call.
        let raw = unsafe { instance.raw.create_device(physical, &create, None) }.named("vkCreateDevice", "device")?;
        let owned = OwnedDevice(raw.clone());

        // SAFETY: `Parts` drops the device's last user, and with it the allocator, before the device.
        let allocator = unsafe { BlockAllocator::new(&instance.raw, physical, &raw) };
        let folder = options.pipeline_folder.as_deref();
        let cache =
            folder.map(|folder| Cache::new(&raw, folder, pipelines::identity(&instance.raw, physical))).transpose()?;
        let host = HostDevice {
            instance: instance.raw.clone(),
            physical,
            device: raw.clone(),
            queue_family,
            allocator: Arc::new(allocator),
            debug_names: instance.debug_utils,
            pipeline_statistics: core.pipeline_statistics_query == vk::TRUE,
            pipeline_cache: cache.as_ref().map_or(vk::PipelineCache::null(), |cache| cache.handle),
            memory_budget: options.memory_budget,
        };
        // SAFETY: made above with the requirements; `Parts` and `Drop` keep it until the last user is gone.
        let device = unsafe { Device::limited(host, lower) };
        // SAFETY: the device was made with one queue of this family.
        let queue = unsafe { Queue::new(&raw, queue_family) };
        let parts = Parts { queue, device, cache, _owned: owned, _instance: instance };
        Ok(Self { kept: Mutex::default(), parts: ManuallyDrop::new(parts), messages })
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
        self.device().alive()?;
        let submit = || {
            let mut submission = self.submission()?;
            let recorded = submission.start(record)?;
            submission.finish()?;
            Ok(recorded)
        };
        submit().inspect_err(|error| self.device().note(error))
    }

    /// A command buffer of its own, for submissions to the queue.
    fn submission(&self) -> Result<Submission, GpuError> {
        Submission::new(&self.parts.device, &self.parts.queue)
    }

    /// Writes the pipelines compiled so far to their file in [`HeadlessOptions::pipeline_folder`]. The drop does so
    /// too, and ignores errors.
    ///
    /// # Errors
    /// Of the file system, or of the driver.
    pub fn save_pipelines(&mut self) -> io::Result<()> {
        self.parts.cache.as_mut().map_or(Ok(()), Cache::save)
    }

    /// Holds the pipelines that exist for as long as the device lives: what needs equal ones later is made sooner.
    pub fn keep_pipelines(&self) {
        *lock(&self.kept) = self.device().made_pipelines();
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
        lock(&self.kept).clear();
        if !self.parts.device.is_lost() {
            let _ = self.save_pipelines(); // on an error the next run compiles them again
        }
        if self.parts.device.is_last() && !self.parts.device.is_gone() {
            // SAFETY: dropped once, here; nothing made from the device lives.
            unsafe { ManuallyDrop::drop(&mut self.parts) };
            return;
        }
        // Whatever lives may still be used and will free itself: the device must stay for it.
        let objects = self.parts.device.objects();
        let text = if objects.is_empty() {
            "the GPU never finished: its device stays".to_owned()
        } else {
            format!("alive after their device: {}", objects.join(", "))
        };
        self.messages.push(Message { severity: Severity::Error, id: "selvedge-leak".to_owned(), text });
    }
}

/// A cache of compiled pipelines and its file.
struct Cache {
    device: ash::Device,
    handle: vk::PipelineCache,
    file: PipelineFile,
}

impl Cache {
    fn new(device: &ash::Device, folder: &Path, identity: [u8; pipelines::IDENTITY]) -> Result<Self, GpuError> {
        let (file, data) = PipelineFile::open(folder, identity);
        let create = vk::PipelineCacheCreateInfo::default().initial_data(&data);
        // SAFETY: the device is alive; the data is what its driver gave.
        let handle =
            unsafe { device.create_pipeline_cache(&create, None) }.named("vkCreatePipelineCache", "pipelines")?;
        Ok(Self { device: device.clone(), handle, file })
    }

    fn save(&mut self) -> io::Result<()> {
        // SAFETY: made by this device.
        let data = unsafe { self.device.get_pipeline_cache_data(self.handle) };
        self.file.write(&data.map_err(io::Error::other)?)
    }
}

impl Drop for Cache {
    fn drop(&mut self) {
        // SAFETY: no pipeline is being made.
        unsafe { self.device.destroy_pipeline_cache(self.handle, None) }
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
