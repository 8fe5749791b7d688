//! The host's device: functions, limits, allocator, living pipelines, and a list of living objects.

use super::budget::Heaps;
use super::description::Description;
use super::memory::lock;
use super::pipeline::Made;
use super::upload::STAGING_BYTES;
use super::{GpuError, HostDevice, MemoryAllocator, MemoryReport, Pool, Quirks, Texel};
use ash::vk;
use ash::vk::Handle;
use std::collections::{BTreeMap, HashMap};
use std::ffi::CString;
use std::sync::atomic::{AtomicBool, AtomicI64, AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, Weak};
use std::time::{Duration, Instant};

/// Replaces limits of a device by lower ones, so that tests reach them with small scenes.
#[doc(hidden)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LowerLimits {
    /// Of `maxComputeWorkGroupCount`, in x.
    pub work_groups: Option<u32>,
    /// Of `maxStorageBufferRange`, in bytes, and of the bytes of a texel buffer.
    pub storage_range: Option<u32>,
    /// Of the staging memory of a renderer's frames, bytes.
    pub staging: Option<u64>,
}

impl LowerLimits {
    /// No change.
    pub const NONE: Self = Self { work_groups: None, storage_range: None, staging: None };

    fn lower(self, limits: &mut vk::PhysicalDeviceLimits) {
        let least = |limit: &mut u32, lower: Option<u32>| *limit = lower.map_or(*limit, |lower| lower.min(*limit));
        least(&mut limits.max_compute_work_group_count[0], self.work_groups);
        least(&mut limits.max_storage_buffer_range, self.storage_range);
        let texels = self.storage_range.map(|bytes| bytes / Texel::U32x2.bytes() as u32);
        least(&mut limits.max_texel_buffer_elements, texels);
    }
}

/// A cheap handle to the host's device; every wrapper has one.
#[derive(Clone)]
pub struct Device(Arc<Inner>);

struct Inner {
    raw: ash::Device,
    push_descriptor: ash::khr::push_descriptor::Device,
    debug_utils: Option<ash::ext::debug_utils::Device>,
    queue_family: u32,
    timestamp_bits: u32,
    pipeline_statistics: bool,
    pipeline_cache: vk::PipelineCache,
    heaps: Heaps,
    limits: vk::PhysicalDeviceLimits,
    name: String,
    driver: String,
    quirks: Quirks,
    stencil_format: vk::Format,
    allocator: Arc<dyn MemoryAllocator>,
    staging_bytes: u64,
    pool_bytes: [AtomicI64; Pool::ALL.len()],
    objects: Mutex<BTreeMap<u64, (String, u64)>>,
    next_object: AtomicU64,
    pipelines: Mutex<HashMap<Description, Weak<Made>>>,
    pipeline_nanoseconds: AtomicU64,
    /// The call that first returned `VK_ERROR_DEVICE_LOST`, and its object.
    lost: OnceLock<(&'static str, String)>,
    /// The device's handle is no longer valid.
    gone: AtomicBool,
    /// Rewrites each shader: tests imitate the arithmetic of other GPUs.
    #[cfg(test)]
    rewriting: OnceLock<Rewriting>,
}

/// A Vulkan pipeline of the device.
#[cfg(feature = "headless")]
pub(crate) type SharedPipeline = Arc<dyn std::any::Any + Send + Sync>;

/// One SPIR-V module to another.
#[cfg(test)]
pub(crate) type Rewriting = fn(&[u32]) -> Vec<u32>;

impl Device {
    /// Borrows the host's device.
    ///
    /// # Safety
    /// The handles are valid and belong together as [`HostDevice`] states, and stay so until the last clone of this value
    /// and everything made from it is dropped.
    pub unsafe fn new(host: HostDevice) -> Self {
        // SAFETY: the caller's promise.
        unsafe { Self::limited(host, LowerLimits::NONE) }
    }

    /// As [`new`](Self::new), with lower limits.
    ///
    /// # Safety
    /// As [`new`](Self::new).
    pub(crate) unsafe fn limited(host: HostDevice, lower: LowerLimits) -> Self {
        let HostDevice { instance, physical, device, queue_family, allocator, debug_names, .. } = host;
        let HostDevice { pipeline_statistics, pipeline_cache, memory_budget, .. } = host;
        let mut driver = vk::PhysicalDeviceDriverProperties::default();
        let mut properties = vk::PhysicalDeviceProperties2::default().push_next(&mut driver);
        // SAFETY: the caller's promise; driver properties are part of Vulkan 1.2.
        unsafe { instance.get_physical_device_properties2(physical, &mut properties) };
        let mut properties = properties.properties;
        lower.lower(&mut properties.limits);
        // SAFETY: the caller's promise.
        let of_stencil = unsafe { instance.get_physical_device_format_properties(physical, vk::Format::S8_UINT) };
        let is_attachment = vk::FormatFeatureFlags::DEPTH_STENCIL_ATTACHMENT;
        // Vulkan 1.3, section 34.3 guarantees one of the other two
        let stencil_format = if of_stencil.optimal_tiling_features.contains(is_attachment) {
            vk::Format::S8_UINT
        } else {
            let format = vk::Format::D24_UNORM_S8_UINT;
            // SAFETY: the caller's promise.
            let of_both = unsafe { instance.get_physical_device_format_properties(physical, format) };
            let has_both = of_both.optimal_tiling_features.contains(is_attachment);
            if has_both { format } else { vk::Format::D32_SFLOAT_S8_UINT }
        };
        // SAFETY: the caller's promise.
        let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
        Self(Arc::new(Inner {
            push_descriptor: ash::khr::push_descriptor::Device::new(&instance, &device),
            debug_utils: debug_names.then(|| ash::ext::debug_utils::Device::new(&instance, &device)),
            raw: device,
            queue_family,
            timestamp_bits: families[queue_family as usize].timestamp_valid_bits,
            pipeline_statistics,
            pipeline_cache,
            // SAFETY: the caller's promise.
            heaps: unsafe { Heaps::new(&instance, physical, memory_budget) },
            limits: properties.limits,
            name: text(&properties.device_name),
            driver: format!("{} {}", text(&driver.driver_name), text(&driver.driver_info)),
            quirks: Quirks::of(driver.driver_id),
            stencil_format,
            allocator,
            staging_bytes: lower.staging.map_or(STAGING_BYTES, |lower| lower.min(STAGING_BYTES)),
            pool_bytes: Default::default(),
            objects: Mutex::default(),
            next_object: AtomicU64::new(0),
            pipelines: Mutex::default(),
            pipeline_nanoseconds: AtomicU64::new(0),
            lost: OnceLock::new(),
            gone: AtomicBool::new(false),
            #[cfg(test)]
            rewriting: OnceLock::new(),
        }))
    }

    /// The device is lost; nothing can be drawn with it.
    pub fn is_lost(&self) -> bool {
        self.0.lost.get().is_some()
    }

    /// A call returned `VK_ERROR_DEVICE_LOST`.
    pub(crate) fn set_lost(&self, call: &'static str, resource: &str) {
        // later calls do not replace the first
        let _ = self.0.lost.set((call, resource.to_owned()));
    }

    /// Stores an error after which the device is unusable.
    pub(crate) fn note(&self, error: &GpuError) {
        if let GpuError::DeviceLost { call, resource } = error {
            self.set_lost(call, resource);
        }
    }

    /// Rewrites every shader made after this call.
    #[cfg(test)]
    pub(crate) fn rewrite(&self, rewriting: Rewriting) {
        let _ = self.0.rewriting.set(rewriting);
    }

    #[cfg(test)]
    pub(super) fn rewriting(&self) -> Option<Rewriting> {
        self.0.rewriting.get().copied()
    }

    /// Marks the device's handle as invalid: objects made from it then free only host memory.
    pub(crate) fn abandon(&self) {
        self.0.gone.store(true, Ordering::Relaxed);
        self.0.allocator.abandon();
    }

    /// The device's handle is no longer valid.
    #[cfg(feature = "headless")]
    pub(crate) fn is_gone(&self) -> bool {
        self.living().is_none()
    }

    /// [`GpuError::DeviceLost`] of the first call that returned it.
    pub(crate) fn alive(&self) -> Result<(), GpuError> {
        match self.0.lost.get() {
            None => Ok(()),
            Some((call, resource)) => Err(GpuError::DeviceLost { call, resource: resource.clone() }),
        }
    }

    /// Vulkan's functions, to destroy objects; `None` if the device's handle is no longer valid. The handle of a lost
    /// device is valid: its objects must be destroyed before it (Vulkan 1.3, section 5.2.3, "Lost Device").
    pub(super) fn living(&self) -> Option<&ash::Device> {
        (!self.0.gone.load(Ordering::Relaxed)).then_some(&self.0.raw)
    }

    /// Vulkan's functions for this device.
    pub fn raw(&self) -> &ash::Device {
        &self.0.raw
    }

    /// Family of the command buffers that may be recorded.
    pub fn queue_family(&self) -> u32 {
        self.0.queue_family
    }

    /// Vulkan's limits.
    pub fn limits(&self) -> &vk::PhysicalDeviceLimits {
        &self.0.limits
    }

    /// A format for attachments with 8 bits of stencil and, if possible, nothing else.
    pub fn stencil_format(&self) -> vk::Format {
        self.0.stencil_format
    }

    /// Known faults of this driver.
    pub fn quirks(&self) -> Quirks {
        self.0.quirks
    }

    /// The device's name.
    pub fn name(&self) -> &str {
        &self.0.name
    }

    /// The driver's name and version.
    pub fn driver(&self) -> &str {
        &self.0.driver
    }

    /// Bytes of memory that live buffers and images occupy, per pool in the order of [`Pool::ALL`].
    pub fn pool_bytes(&self) -> [(Pool, u64); Pool::ALL.len()] {
        Pool::ALL.map(|pool| (pool, self.0.pool_bytes[pool as usize].load(Ordering::Relaxed).max(0) as u64))
    }

    /// Total time that the driver has spent making pipelines, summed over threads.
    pub fn pipeline_time(&self) -> Duration {
        Duration::from_nanos(self.0.pipeline_nanoseconds.load(Ordering::Relaxed))
    }

    /// Names of the live buffers, images and pipelines, oldest first.
    pub fn objects(&self) -> Vec<String> {
        lock(&self.0.objects).values().map(|(name, _)| name.clone()).collect()
    }

    /// The same with the bytes of memory that each takes; 0 for a pipeline.
    pub fn object_bytes(&self) -> Vec<(String, u64)> {
        lock(&self.0.objects).values().cloned().collect()
    }

    /// This is the last handle, and no object made from the device is left.
    #[cfg(feature = "headless")]
    pub(crate) fn is_last(&self) -> bool {
        Arc::strong_count(&self.0) == 1
    }

    pub(crate) fn push_descriptor(&self) -> &ash::khr::push_descriptor::Device {
        &self.0.push_descriptor
    }

    pub(crate) fn debug_utils(&self) -> Option<&ash::ext::debug_utils::Device> {
        self.0.debug_utils.as_ref()
    }

    /// Number of valid bits of a timestamp; 0 if the queue family has none.
    pub(crate) fn timestamp_bits(&self) -> u32 {
        self.0.timestamp_bits
    }

    pub(super) fn pipeline_cache(&self) -> vk::PipelineCache {
        self.0.pipeline_cache
    }

    pub(super) fn heaps(&self) -> &Heaps {
        &self.0.heaps
    }

    /// The host's budget: most bytes of memory on this device.
    pub fn memory_budget(&self) -> Option<u64> {
        self.0.heaps.most()
    }

    pub(crate) fn pipeline_statistics(&self) -> bool {
        self.0.pipeline_statistics
    }

    pub(super) fn allocator(&self) -> &dyn MemoryAllocator {
        self.0.allocator.as_ref()
    }

    /// The bytes of the allocator.
    pub fn memory_report(&self) -> MemoryReport {
        self.0.allocator.report()
    }

    /// Most bytes of staging memory that all frames of a renderer hold together.
    pub(crate) fn staging_bytes(&self) -> u64 {
        self.0.staging_bytes
    }

    pub(crate) fn count_bytes(&self, pool: Pool, change: i64) {
        self.0.pool_bytes[pool as usize].fetch_add(change, Ordering::Relaxed);
    }

    /// Sets the name of `handle` in validation messages and captures.
    pub(crate) fn set_name<H: Handle>(&self, handle: H, name: &str) {
        let (Some(debug), Ok(name)) = (self.debug_utils(), CString::new(name)) else { return };
        let info = vk::DebugUtilsObjectNameInfoEXT::default().object_handle(handle).object_name(&name);
        // an error is ignored: names do not change the picture
        // SAFETY: the handle belongs to this device and is not in use elsewhere yet.
        let _ = unsafe { debug.set_debug_utils_object_name(&info) };
    }

    /// Runs `make`, which makes a pipeline, and adds its time.
    pub(super) fn timing_pipeline<T>(&self, make: impl FnOnce() -> T) -> T {
        let start = Instant::now();
        let made = make();
        self.0.pipeline_nanoseconds.fetch_add(start.elapsed().as_nanos() as u64, Ordering::Relaxed);
        made
    }

    /// The existing pipeline of a description.
    pub(super) fn pipeline(&self, description: &Description) -> Option<Arc<Made>> {
        lock(&self.0.pipelines).get(description)?.upgrade()
    }

    /// Registers the pipeline of a description, for as long as it exists.
    pub(super) fn share_pipeline(&self, description: Description, made: &Arc<Made>) {
        let mut pipelines = lock(&self.0.pipelines);
        pipelines.retain(|_, made| made.strong_count() > 0);
        pipelines.insert(description, Arc::downgrade(made));
    }

    /// The Vulkan pipelines that exist. Whoever holds them lets later passes of equal descriptions share them.
    #[cfg(feature = "headless")]
    pub(crate) fn made_pipelines(&self) -> Vec<SharedPipeline> {
        let made = lock(&self.0.pipelines).values().filter_map(Weak::upgrade).collect::<Vec<_>>();
        made.into_iter().map(|made| made as SharedPipeline).collect()
    }

    /// Lists a named object of so many bytes until the returned entry is dropped.
    pub(crate) fn register(&self, name: &str, bytes: u64) -> Registration {
        let key = self.0.next_object.fetch_add(1, Ordering::Relaxed);
        lock(&self.0.objects).insert(key, (name.to_owned(), bytes));
        Registration { device: self.clone(), key }
    }
}

impl std::fmt::Debug for Device {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "Device({}, {})", self.0.name, self.0.driver)
    }
}

/// Vulkan's text in an array of fixed size.
pub(crate) fn text(chars: &[std::ffi::c_char]) -> String {
    let bytes: Vec<u8> = chars.iter().map(|&c| c as u8).take_while(|&c| c != 0).collect();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// An entry in the list of live objects.
#[derive(Debug)]
pub(crate) struct Registration {
    device: Device,
    key: u64,
}

impl Registration {
    pub(crate) fn device(&self) -> &Device {
        &self.device
    }
}

impl Drop for Registration {
    fn drop(&mut self) {
        lock(&self.device.0.objects).remove(&self.key);
    }
}
