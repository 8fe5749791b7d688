//! What a host hands over: its device, and its allocator.

use super::{BlockAllocator, MemoryAllocator};
use ash::vk;
use ash::vk::Handle;
use std::ffi::c_void;
use std::sync::Arc;

/// The host's objects. The engine destroys none of them.
#[derive(Clone)]
pub struct HostDevice {
    /// The instance of `physical`.
    pub instance: ash::Instance,
    /// A device for which [`Requirements::missing`](super::Requirements::missing) is empty.
    pub physical: vk::PhysicalDevice,
    /// Made with the features and extensions of [`Requirements`](super::Requirements).
    pub device: ash::Device,
    /// Family of the command buffers that the engine will record into.
    pub queue_family: u32,
    /// Where memory of this device comes from: the host's allocator, `GpuAllocator` around a gpu-allocator that the host
    /// uses, too, or a [`BlockAllocator`].
    pub allocator: Arc<dyn MemoryAllocator>,
    /// The instance has `VK_EXT_debug_utils`: objects and passes get names.
    pub debug_names: bool,
    /// The device has the feature `pipelineStatisticsQuery`: the triangle count is measured.
    pub pipeline_statistics: bool,
    /// The cache for all pipelines; null for none. It must outlive everything made from the device, and meanwhile the
    /// host must not merge into it.
    pub pipeline_cache: vk::PipelineCache,
    /// Most bytes of the engine's buffers and images on this device. What its heaps have left bounds them in any case.
    pub memory_budget: Option<u64>,
}

/// A host's device by its handles, for hosts with other bindings of Vulkan than the engine's version of ash.
///
/// A handle is the number that Vulkan's header has: of a pointer, its address. Other handles become the engine's types the
/// same way: [`ash::vk::Handle::from_raw`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct RawDevice {
    /// The address of `vkGetInstanceProcAddr`.
    pub get_instance_proc_addr: *const c_void,
    /// `VkInstance`, made for Vulkan 1.3.
    pub instance: u64,
    /// `VkPhysicalDevice` that lacks nothing of [`Requirements`](super::Requirements).
    pub physical: u64,
    /// `VkDevice` with the features and extensions of [`Requirements`](super::Requirements).
    pub device: u64,
    /// Family of the host's command buffers, for graphics and compute.
    pub queue_family: u32,
}

impl HostDevice {
    /// The device of these handles, with a [`BlockAllocator`], and without names, statistics, a pipeline cache and a budget.
    /// A host sets other fields as it likes: `HostDevice { allocator, ..host }`.
    ///
    /// It needs no queue: the engine records into the host's command buffers, and the host submits them.
    ///
    /// # Safety
    /// `get_instance_proc_addr` is the loader's function, of the C calling convention of the system, and stays loaded.
    /// The other handles are alive and belong together as [`RawDevice`] says. Everything made from the value is dropped
    /// before the device is destroyed, and the value before the instance is.
    ///
    /// # Panics
    /// When an address or a handle is 0.
    pub unsafe fn from_raw(raw: RawDevice) -> Self {
        let RawDevice { get_instance_proc_addr, instance, physical, device, queue_family } = raw;
        assert!(physical != 0 && device != 0, "the physical device or the device is a null handle");
        // SAFETY: the caller's promise.
        let instance = unsafe { load_instance(get_instance_proc_addr, instance) };
        let physical = vk::PhysicalDevice::from_raw(physical);
        // SAFETY: the caller's promise.
        let device = unsafe { ash::Device::load(instance.fp_v1_0(), vk::Device::from_raw(device)) };
        // SAFETY: the caller's promise.
        let allocator = Arc::new(unsafe { BlockAllocator::new(&instance, physical, &device) });
        Self {
            instance,
            physical,
            device,
            queue_family,
            allocator,
            debug_names: false,
            pipeline_statistics: false,
            pipeline_cache: vk::PipelineCache::null(),
            memory_budget: None,
        }
    }
}

/// An instance by its handle, as [`Requirements::missing`](super::Requirements::missing) takes it before there is a device.
///
/// # Safety
/// As [`HostDevice::from_raw`] says of the two.
///
/// # Panics
/// When one of them is 0.
pub unsafe fn load_instance(get_instance_proc_addr: *const c_void, instance: u64) -> ash::Instance {
    assert!(!get_instance_proc_addr.is_null() && instance != 0, "vkGetInstanceProcAddr or the instance is null");
    // SAFETY: the caller's promise: a function of this type. A dispatchable handle is a pointer for it, too.
    let get_instance_proc_addr =
        unsafe { std::mem::transmute::<*const c_void, vk::PFN_vkGetInstanceProcAddr>(get_instance_proc_addr) };
    // SAFETY: the caller's promise.
    unsafe { ash::Instance::load(&ash::StaticFn { get_instance_proc_addr }, vk::Instance::from_raw(instance)) }
}
