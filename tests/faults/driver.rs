//! A double of the Vulkan driver, in place of the loader's vkGetInstanceProcAddr. It counts calls, lists living handles
//! and makes one call fail.
//!
//! ```text
//!   engine ── ash ── vkGetInstanceProcAddr ─▶ double ──through──▶ the system's driver
//!                                               └──null────▶ handles by number, memory of the test's own, no picture
//! ```
//!
//! A call that shall fail is not passed on to the driver. One call is the exception: vkWaitForFences waits before it
//! returns that the device is lost, so that the GPU has finished when handles are destroyed.
//!
//! Handles of the device and of its objects are listed; instances and destroyed surfaces are counted. Events and
//! descriptor pools are neither.

#[path = "instances.rs"]
mod instances;

use ash::vk;
use ash::vk::Handle;
use instances::{create_instance, destroy_instance, destroy_surface, extensions, memory_properties, presents};
use instances::{surface_capabilities, surface_formats};
use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::ffi::{CStr, c_char, c_void};
use std::mem::transmute;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

/// The call that shall fail, the `nth` of its name counted from 0, and the result that it returns.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Fault {
    pub call: &'static str,
    pub nth: u32,
    pub result: vk::Result,
}

/// The address of a function.
macro_rules! address {
    ($function:expr) => {
        $function as *const () as usize
    };
}

#[derive(Default)]
struct State {
    null: bool,
    fault: Option<Fault>,
    injected: u32,
    instances: i32,
    /// With the null driver, all are this one of the system: making one takes half of the time of a short script.
    instance: Option<u64>,
    surfaces_destroyed: u32,
    /// Width and height of each surface, with the null driver.
    window: (u32, u32),
    calls: BTreeMap<&'static str, u32>,
    /// Kind and handle.
    living: BTreeSet<(&'static str, u64)>,
    /// The driver's functions, by name.
    real: HashMap<&'static str, usize>,
    handles: u64,
    /// `VK_EXT_memory_budget` says that all heaps are full, or that they are empty; `None`: what the driver says.
    full: Option<bool>,
    /// Bytes of null buffers and images, and of memory.
    bytes: HashMap<u64, u64>,
    memory: HashMap<u64, Vec<u64>>,
}

static STATE: Mutex<Option<State>> = Mutex::new(None);
/// Calls of the null driver that cannot fail, except calls that free.
static OTHERS: AtomicU32 = AtomicU32::new(0);
static TURN: Mutex<()> = Mutex::new(());
/// An instance that the double does not see, never destroyed. It keeps the system's drivers loaded: the loader unloads
/// them with the last instance, and loading them takes most of the time of a short script.
static KEPT: OnceLock<(ash::Entry, ash::Instance)> = OnceLock::new();

fn with<T>(f: impl FnOnce(&mut State) -> T) -> T {
    f(STATE.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert_default())
}

/// The double, one at a time.
pub struct Driver {
    _loader: ash::Entry,
    _turn: MutexGuard<'static, ()>,
}

impl Driver {
    /// `null`: the double replaces the device; only queries of the instance and the physical device reach the system's
    /// driver.
    pub fn new(null: bool) -> Self {
        let turn = TURN.lock().unwrap_or_else(PoisonError::into_inner);
        // SAFETY: the system's loader.
        let loader = unsafe { ash::Entry::load() }.expect("these tests need Vulkan: apt install libvulkan1");
        KEPT.get_or_init(|| {
            // SAFETY: the entry is loaded, and stays so beside its instance.
            let instance = unsafe { loader.create_instance(&vk::InstanceCreateInfo::default(), None) };
            (loader.clone(), instance.expect("the loader makes an instance"))
        });
        let real = loader.static_fn().get_instance_proc_addr;
        let real = address!(real);
        *STATE.lock().unwrap_or_else(PoisonError::into_inner) = Some(State {
            null,
            real: HashMap::from([("vkGetInstanceProcAddr", real)]),
            handles: 1,
            ..State::default()
        });
        Self { _loader: loader, _turn: turn }
    }

    /// The entry point to give to the engine.
    pub fn entry(&self) -> ash::Entry {
        // SAFETY: the double answers as the loader does.
        unsafe { ash::Entry::from_static_fn(ash::StaticFn { get_instance_proc_addr }) }
    }

    /// Resets the counts, and makes this call fail from now on.
    pub fn plan(&self, fault: Option<Fault>) {
        with(|state| {
            (state.fault, state.injected) = (fault, 0);
            state.calls.clear();
        });
        OTHERS.store(0, Ordering::Relaxed);
    }

    /// From now on `VK_EXT_memory_budget` is there, and says that all heaps are full or empty.
    pub fn tell_heaps(&self, full: bool) {
        with(|state| state.full = Some(full));
    }

    /// Number of calls that failed by plan.
    pub fn injected(&self) -> u32 {
        with(|state| state.injected)
    }

    /// Number of calls since the last plan, for each call that may fail.
    pub fn calls(&self) -> BTreeMap<&'static str, u32> {
        with(|state| state.calls.clone())
    }

    /// Number of calls since the last plan, except calls that free.
    pub fn count(&self) -> u32 {
        with(|state| state.calls.values().sum::<u32>()) + OTHERS.load(Ordering::Relaxed)
    }

    /// Number of instances that have not been destroyed.
    pub fn instances(&self) -> i32 {
        with(|state| state.instances)
    }

    /// Number of surfaces that were destroyed, with the null driver.
    #[allow(dead_code)] // the viewer's test includes this file
    pub fn surfaces_destroyed(&self) -> u32 {
        with(|state| state.surfaces_destroyed)
    }

    /// From now on every surface has this size, with the null driver.
    #[allow(dead_code)] // the viewer's test includes this file
    pub fn set_window(&self, size: (u32, u32)) {
        with(|state| state.window = size);
    }

    /// Handles that have not been destroyed: for each one the name of the call that frees it, and `-` for a device.
    pub fn living(&self) -> Vec<&'static str> {
        with(|state| state.living.iter().map(|(kind, _)| *kind).collect())
    }
}

/// Counts a call, and either makes it or returns the planned failure.
fn call(name: &'static str, make: impl FnOnce() -> vk::Result) -> vk::Result {
    let failure = with(|state| {
        let made = state.calls.entry(name).or_default();
        *made += 1;
        let fails = state.fault.filter(|fault| fault.call == name && fault.nth + 1 == *made);
        state.injected += u32::from(fails.is_some());
        fails.map(|fault| fault.result)
    });
    match failure {
        None => make(),
        Some(result) => {
            if name == "vkWaitForFences" && result == vk::Result::ERROR_DEVICE_LOST {
                let _ = make();
            }
            result
        }
    }
}

/// The driver's own function.
fn real(name: &'static str) -> Option<usize> {
    with(|state| state.real.get(name).copied())
}

fn born(kind: &'static str, handle: u64) {
    assert!(with(|state| state.living.insert((kind, handle))), "{kind} {handle} twice");
}

fn died(kind: &'static str, handle: u64) {
    assert!(handle == 0 || with(|state| state.living.remove(&(kind, handle))), "{kind} {handle} was not alive");
}

fn fresh() -> u64 {
    with(|state| {
        state.handles += 1;
        state.handles
    })
}

type Callbacks = *const vk::AllocationCallbacks<'static>;
type Create<O, I, H> = unsafe extern "system" fn(O, *const I, Callbacks, *mut H) -> vk::Result;
type Destroy<O, H> = unsafe extern "system" fn(O, H, Callbacks);

/// Pairs of a call that makes a handle and the call that frees it.
macro_rules! pairs {
    ($($make:ident $free:ident: $owner:ty, $info:ty => $handle:ty, $made_by:literal $freed_by:literal, $bytes:expr;)*) => {
        $(unsafe extern "system" fn $make(owner: $owner, info: *const $info, none: Callbacks, made: *mut $handle) -> vk::Result {
            // SAFETY: as Vulkan's rules for the call promise.
            unsafe {
                let result = call($made_by, || match real($made_by) {
                    Some(real) => transmute::<usize, Create<$owner, $info, $handle>>(real)(owner, info, none, made),
                    None => {
                        let handle = fresh();
                        let bytes: fn(&$info) -> u64 = $bytes;
                        with(|state| state.bytes.insert(handle, bytes(&*info)));
                        *made = <$handle>::from_raw(handle);
                        vk::Result::SUCCESS
                    }
                });
                if result == vk::Result::SUCCESS {
                    born($freed_by, (*made).as_raw());
                }
                result
            }
        }

        unsafe extern "system" fn $free(owner: $owner, handle: $handle, none: Callbacks) {
            died($freed_by, handle.as_raw());
            with(|state| state.memory.remove(&handle.as_raw()));
            if let Some(real) = real($freed_by) {
                // SAFETY: as Vulkan's rules for the call promise.
                unsafe { transmute::<usize, Destroy<$owner, $handle>>(real)(owner, handle, none) }
            }
        })*

        fn pair(name: &[u8]) -> Option<(&'static str, usize)> {
            $(if name == $made_by.as_bytes() {
                let function: Create<$owner, $info, $handle> = $make;
                return Some(($made_by, address!(function)));
            }
            if name == $freed_by.as_bytes() {
                let function: Destroy<$owner, $handle> = $free;
                return Some(($freed_by, address!(function)));
            })*
            None
        }
    };
}

pairs! {
    create_device destroy_nothing: vk::PhysicalDevice, vk::DeviceCreateInfo<'static> => vk::Device, "vkCreateDevice" "-", |_| 0;
    create_buffer destroy_buffer: vk::Device, vk::BufferCreateInfo<'static> => vk::Buffer, "vkCreateBuffer" "vkDestroyBuffer", |i| i.size;
    create_buffer_view destroy_buffer_view: vk::Device, vk::BufferViewCreateInfo<'static> => vk::BufferView, "vkCreateBufferView" "vkDestroyBufferView", |_| 0;
    create_image destroy_image: vk::Device, vk::ImageCreateInfo<'static> => vk::Image, "vkCreateImage" "vkDestroyImage", |i| 16 * u64::from(i.extent.width * i.extent.height);
    create_image_view destroy_image_view: vk::Device, vk::ImageViewCreateInfo<'static> => vk::ImageView, "vkCreateImageView" "vkDestroyImageView", |_| 0;
    create_sampler destroy_sampler: vk::Device, vk::SamplerCreateInfo<'static> => vk::Sampler, "vkCreateSampler" "vkDestroySampler", |_| 0;
    create_shader_module destroy_shader_module: vk::Device, vk::ShaderModuleCreateInfo<'static> => vk::ShaderModule, "vkCreateShaderModule" "vkDestroyShaderModule", |_| 0;
    create_set_layout destroy_set_layout: vk::Device, vk::DescriptorSetLayoutCreateInfo<'static> => vk::DescriptorSetLayout, "vkCreateDescriptorSetLayout" "vkDestroyDescriptorSetLayout", |_| 0;
    create_pipeline_layout destroy_pipeline_layout: vk::Device, vk::PipelineLayoutCreateInfo<'static> => vk::PipelineLayout, "vkCreatePipelineLayout" "vkDestroyPipelineLayout", |_| 0;
    create_cache destroy_cache: vk::Device, vk::PipelineCacheCreateInfo<'static> => vk::PipelineCache, "vkCreatePipelineCache" "vkDestroyPipelineCache", |_| 0;
    create_query_pool destroy_query_pool: vk::Device, vk::QueryPoolCreateInfo<'static> => vk::QueryPool, "vkCreateQueryPool" "vkDestroyQueryPool", |_| 0;
    create_command_pool destroy_command_pool: vk::Device, vk::CommandPoolCreateInfo<'static> => vk::CommandPool, "vkCreateCommandPool" "vkDestroyCommandPool", |_| 0;
    create_fence destroy_fence: vk::Device, vk::FenceCreateInfo<'static> => vk::Fence, "vkCreateFence" "vkDestroyFence", |_| 0;
    create_semaphore destroy_semaphore: vk::Device, vk::SemaphoreCreateInfo<'static> => vk::Semaphore, "vkCreateSemaphore" "vkDestroySemaphore", |_| 0;
    create_swapchain destroy_swapchain: vk::Device, vk::SwapchainCreateInfoKHR<'static> => vk::SwapchainKHR, "vkCreateSwapchainKHR" "vkDestroySwapchainKHR", |_| 0;
    allocate_memory free_memory: vk::Device, vk::MemoryAllocateInfo<'static> => vk::DeviceMemory, "vkAllocateMemory" "vkFreeMemory", |i| i.allocation_size;
}

unsafe extern "system" fn destroy_device(device: vk::Device, none: Callbacks) {
    died("-", device.as_raw());
    if let Some(real) = real("vkDestroyDevice") {
        // SAFETY: as Vulkan's rules for the call promise.
        unsafe { transmute::<usize, vk::PFN_vkDestroyDevice>(real)(device, none.cast()) }
    }
}

/// Other calls that may fail, each with the work of the null driver.
macro_rules! calls {
    ($($function:ident $name:literal ($($argument:ident: $type:ty),*) $null:expr;)*) => {
        $(#[allow(clippy::too_many_arguments)] // as many as Vulkan has
        unsafe extern "system" fn $function($($argument: $type),*) -> vk::Result {
            call($name, || match real($name) {
                // SAFETY: as Vulkan's rules for the call promise.
                Some(real) => unsafe {
                    transmute::<usize, unsafe extern "system" fn($($type),*) -> vk::Result>(real)($($argument),*)
                },
                None => {
                    $null
                    vk::Result::SUCCESS
                }
            })
        })*

        fn other(name: &[u8]) -> Option<(&'static str, usize)> {
            $(if name == $name.as_bytes() {
                let function: unsafe extern "system" fn($($type),*) -> vk::Result = $function;
                return Some(($name, address!(function)));
            })*
            None
        }
    };
}

calls! {
    physical_devices "vkEnumeratePhysicalDevices" (instance: vk::Instance, count: *mut u32, made: *mut u64) {};
    map_memory "vkMapMemory" (device: vk::Device, memory: u64, offset: u64, size: u64, flags: u32, made: *mut *mut c_void) {
        let mapped = with(|state| {
            let words = state.bytes[&memory].div_ceil(8) as usize;
            state.memory.entry(memory).or_insert_with(|| vec![0; words]).as_mut_ptr()
        });
        // SAFETY: room for the address.
        unsafe { *made = mapped.cast() };
    };
    bind_buffer "vkBindBufferMemory" (device: vk::Device, buffer: u64, memory: u64, offset: u64) {
        // what another buffer left there would be read as what the GPU wrote
        with(|state| {
            let (first, end) = (offset as usize / 8, (offset + state.bytes[&buffer]).div_ceil(8) as usize);
            state.memory.get_mut(&memory).into_iter().for_each(|words| words[first..end].fill(0));
        });
    };
    swapchain_images "vkGetSwapchainImagesKHR" (device: vk::Device, chain: u64, count: *mut u32, made: *mut u64) {
        // SAFETY: room for the number, and for that many where there is an array.
        unsafe {
            *count = 2;
            if !made.is_null() {
                (0..2).for_each(|nth| made.add(nth).write(fresh()));
            }
        }
    };
    bind_image "vkBindImageMemory" (device: vk::Device, image: u64, memory: u64, offset: u64) {};
    command_buffers "vkAllocateCommandBuffers" (device: vk::Device, info: *const c_void, made: *mut u64) {
        // SAFETY: room for one.
        unsafe { *made = fresh() };
    };
    begin "vkBeginCommandBuffer" (commands: vk::CommandBuffer, info: *const c_void) {};
    end "vkEndCommandBuffer" (commands: vk::CommandBuffer) {};
    reset_pool "vkResetCommandPool" (device: vk::Device, pool: u64, flags: u32) {};
    submit "vkQueueSubmit2" (queue: vk::Queue, count: u32, infos: *const c_void, fence: u64) {};
    wait "vkWaitForFences" (device: vk::Device, count: u32, fences: *const u64, all: u32, timeout: u64) {};
    reset_fences "vkResetFences" (device: vk::Device, count: u32, fences: *const u64) {};
    idle "vkQueueWaitIdle" (queue: vk::Queue) {};
    cache_data "vkGetPipelineCacheData" (device: vk::Device, cache: u64, bytes: *mut usize, data: *mut c_void) {
        // SAFETY: room for the size.
        unsafe { *bytes = 0 };
    };
    queries "vkGetQueryPoolResults" (device: vk::Device, pool: u64, first: u32, count: u32, bytes: usize, data: *mut u8, stride: u64, flags: u32) {
        // SAFETY: as large as the caller says.
        unsafe { data.write_bytes(0, bytes) };
    };
}

unsafe extern "system" fn requirements(_: vk::Device, of: u64, needs: *mut vk::MemoryRequirements) {
    let bytes = with(|state| state.bytes[&of]);
    // SAFETY: room for the answer.
    unsafe { *needs = vk::MemoryRequirements { size: bytes.max(16), alignment: 16, memory_type_bits: u32::MAX } };
}

unsafe extern "system" fn queue(_: vk::Device, _: u32, _: u32, made: *mut u64) {
    // SAFETY: room for the answer.
    unsafe { *made = fresh() };
}

/// The engine makes pipelines one at a time.
macro_rules! pipelines {
    ($($function:ident $name:literal;)*) => {
        $(unsafe extern "system" fn $function(
            device: vk::Device, cache: u64, count: u32, info: *const c_void, none: Callbacks, made: *mut u64,
        ) -> vk::Result {
            type Make = unsafe extern "system" fn(vk::Device, u64, u32, *const c_void, Callbacks, *mut u64) -> vk::Result;
            assert_eq!(count, 1);
            // SAFETY: as Vulkan's rules for the call promise.
            unsafe {
                let result = call($name, || match real($name) {
                    Some(real) => transmute::<usize, Make>(real)(device, cache, count, info, none, made),
                    None => {
                        *made = fresh();
                        vk::Result::SUCCESS
                    }
                });
                if result == vk::Result::SUCCESS {
                    born("vkDestroyPipeline", *made);
                }
                result
            }
        })*
    };
}

pipelines! {
    graphics "vkCreateGraphicsPipelines";
    compute "vkCreateComputePipelines";
}

unsafe extern "system" fn destroy_pipeline(device: vk::Device, pipeline: u64, none: Callbacks) {
    died("vkDestroyPipeline", pipeline);
    if let Some(real) = real("vkDestroyPipeline") {
        // SAFETY: as Vulkan's rules for the call promise.
        unsafe { transmute::<usize, Destroy<vk::Device, u64>>(real)(device, pipeline, none) }
    }
}

unsafe extern "system" fn unmap(_: vk::Device, _: u64) {}

/// Stands for all calls that cannot fail. It ignores the arguments of its caller, which the C calling conventions of
/// x86-64 and AArch64 permit.
unsafe extern "system" fn nothing() -> i32 {
    OTHERS.fetch_add(1, Ordering::Relaxed);
    0
}

type Function = vk::PFN_vkVoidFunction;

fn function(address: usize) -> Function {
    // SAFETY: an address of a function, or none.
    unsafe { transmute::<usize, Function>(address) }
}

/// The double's function for a call, if it has one; `original` is the driver's.
fn double(name: &CStr, original: usize) -> Option<usize> {
    let (name, address) = match name.to_bytes() {
        b"vkCreateInstance" => ("vkCreateInstance", address!(create_instance)),
        b"vkDestroyInstance" => ("vkDestroyInstance", address!(destroy_instance)),
        b"vkDestroyDevice" => ("vkDestroyDevice", address!(destroy_device)),
        b"vkDestroyPipeline" => ("vkDestroyPipeline", address!(destroy_pipeline)),
        b"vkCreateGraphicsPipelines" => ("vkCreateGraphicsPipelines", address!(graphics)),
        b"vkCreateComputePipelines" => ("vkCreateComputePipelines", address!(compute)),
        name => pair(name).or_else(|| other(name))?,
    };
    let of_system = ["vkCreateInstance", "vkDestroyInstance", "vkEnumeratePhysicalDevices"].contains(&name);
    with(|state| {
        if !state.null || of_system {
            state.real.insert(name, original);
        }
    });
    Some(address)
}

unsafe extern "system" fn get_instance_proc_addr(instance: vk::Instance, name: *const c_char) -> Function {
    // SAFETY: the loader's function, and a name that ends.
    let (original, name) = unsafe {
        let loader = real("vkGetInstanceProcAddr").expect("a driver was made");
        let loader = transmute::<usize, vk::PFN_vkGetInstanceProcAddr>(loader);
        (loader(instance, name).map_or(0, |f| address!(f)), CStr::from_ptr(name))
    };
    if name == c"vkGetDeviceProcAddr" {
        with(|state| state.real.insert("vkGetDeviceProcAddr", original));
        return function(address!(get_device_proc_addr));
    }
    let told = [
        ("vkEnumerateDeviceExtensionProperties", address!(extensions)),
        ("vkGetPhysicalDeviceMemoryProperties2", address!(memory_properties)),
    ];
    if let Some((name, address)) = told.into_iter().find(|(told, _)| told.as_bytes() == name.to_bytes()) {
        with(|state| state.real.insert(name, original));
        return function(address);
    }
    if with(|state| state.null) {
        match name.to_bytes() {
            b"vkGetPhysicalDeviceSurfaceSupportKHR" => return function(address!(presents)),
            b"vkDestroySurfaceKHR" => return function(address!(destroy_surface)),
            b"vkGetPhysicalDeviceSurfaceCapabilitiesKHR" => return function(address!(surface_capabilities)),
            b"vkGetPhysicalDeviceSurfaceFormatsKHR" => return function(address!(surface_formats)),
            _ => (),
        }
    }
    // functions of devices come from get_device_proc_addr
    let of_instance =
        [c"vkCreateInstance", c"vkDestroyInstance", c"vkEnumeratePhysicalDevices", c"vkCreateDevice"].contains(&name);
    function(if of_instance { double(name, original).unwrap_or(original) } else { original })
}

unsafe extern "system" fn get_device_proc_addr(device: vk::Device, name: *const c_char) -> Function {
    // SAFETY: a name that ends.
    let text = unsafe { CStr::from_ptr(name) };
    let original = if with(|state| state.null) {
        match text.to_bytes() {
            b"vkGetBufferMemoryRequirements" | b"vkGetImageMemoryRequirements" => address!(requirements),
            b"vkGetDeviceQueue" => address!(queue),
            b"vkUnmapMemory" => address!(unmap),
            _ => address!(nothing),
        }
    } else {
        let real = real("vkGetDeviceProcAddr").expect("asked for before");
        // SAFETY: the driver's function.
        unsafe { transmute::<usize, vk::PFN_vkGetDeviceProcAddr>(real)(device, name) }.map_or(0, |f| address!(f))
    };
    function(double(text, original).unwrap_or(original))
}
