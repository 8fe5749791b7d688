//! Vulkan of a window: instance, surface, device, queue, allocator, one command buffer.
//!
//! The viewer uses the engine as any host does: `docs/embedding.md` of the engine is the contract. One frame is in
//! flight; the next is recorded when its fence is signalled.

use super::ViewError;
use super::made::Made;
use ash::vk;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use selvedge::ash;
use selvedge::gpu::{GpuAllocator, HostDevice, Requirements};
use selvedge::gpu_allocator;
use std::ffi::{CStr, c_char, c_void};
use std::mem::ManuallyDrop;
use std::sync::{Arc, Mutex, PoisonError};
use winit::raw_window_handle::{HasDisplayHandle, HasWindowHandle};
use winit::window::Window;

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// Everything of Vulkan that lives as long as the device.
pub struct Context {
    entry: ash::Entry,
    pub instance: ash::Instance,
    debug: Option<(ash::ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    messages: Arc<Mutex<Vec<String>>>,
    pub surfaces: ash::khr::surface::Instance,
    /// Null while the program is suspended.
    pub surface: vk::SurfaceKHR,
    pub physical: vk::PhysicalDevice,
    pub device: ash::Device,
    pub swapchains: ash::khr::swapchain::Device,
    pub push_descriptor: ash::khr::push_descriptor::Device,
    pub family: u32,
    pub queue: vk::Queue,
    allocator: ManuallyDrop<Arc<Mutex<Allocator>>>,
    pub pool: vk::CommandPool,
    pub cmd: vk::CommandBuffer,
    pub fence: vk::Fence,
    pub acquired: vk::Semaphore,
    /// The device's name.
    pub name: String,
}

/// The requested device.
#[derive(Clone, Debug, Default)]
pub struct DeviceOptions {
    /// A part of the wanted device's name.
    pub device: Option<String>,
    /// The validation layer is on, and its messages are collected.
    pub validation: bool,
}

impl Context {
    /// Opens the best device that can draw and present to the window. If that fails, nothing is left of it.
    pub fn new(window: &Window, options: &DeviceOptions) -> Result<Self, ViewError> {
        let display = window.display_handle().map_err(|e| ViewError::Window(e.to_string()))?.as_raw();
        // SAFETY: the system's loader, and a living window.
        unsafe {
            let entry = ash::Entry::load().map_err(|e| ViewError::NoLoader(e.to_string()))?;
            let extensions = ash_window::enumerate_required_extensions(display)?.to_vec();
            Self::of_surface(entry, extensions, options, |entry, instance| surface(entry, instance, window))
        }
    }

    /// As [`new`](Self::new), of the surface that `make_surface` makes with these extensions of the instance.
    ///
    /// # Safety
    /// The surface is that of a living window.
    unsafe fn of_surface(
        entry: ash::Entry,
        mut extensions: Vec<*const c_char>,
        options: &DeviceOptions,
        make_surface: impl FnOnce(&ash::Entry, &ash::Instance) -> Result<vk::SurfaceKHR, ViewError>,
    ) -> Result<Self, ViewError> {
        let messages: Arc<Mutex<Vec<String>>> = Arc::default();
        // declared before all else, so that the allocator is gone before its device
        let mut made = Made::default();
        // SAFETY: plain Vulkan in its usual order: every struct outlives the call that it is given to, the handles of the
        // window are those of a living one, and the messages outlive the instance.
        unsafe {
            let mut layers = Vec::new();
            if options.validation {
                let installed = entry.enumerate_instance_layer_properties()?;
                if !installed.iter().any(|l| l.layer_name_as_c_str() == Ok(VALIDATION_LAYER)) {
                    return Err(ViewError::NoValidation);
                }
                layers.push(VALIDATION_LAYER.as_ptr());
                extensions.push(ash::ext::debug_utils::NAME.as_ptr());
            }
            let app = vk::ApplicationInfo::default()
                .application_name(c"selvedge view")
                .api_version(Requirements::API_VERSION);
            let mut features = vk::ValidationFeaturesEXT::default()
                .enabled_validation_features(&[vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION]);
            let mut create = vk::InstanceCreateInfo::default()
                .application_info(&app)
                .enabled_layer_names(&layers)
                .enabled_extension_names(&extensions);
            if options.validation {
                create = create.push_next(&mut features);
            }
            let instance = entry.create_instance(&create, None)?;
            made.push(&instance, |instance| instance.destroy_instance(None));
            let debug = options.validation.then(|| messenger(&entry, &instance, &messages)).transpose()?;
            if let Some(debug) = &debug {
                made.push(debug, |(debug, messenger)| debug.destroy_debug_utils_messenger(*messenger, None));
            }
            let surfaces = ash::khr::surface::Instance::new(&entry, &instance);
            let surface = make_surface(&entry, &instance)?;
            made.push(&surfaces, move |surfaces| surfaces.destroy_surface(surface, None));
            let (physical, family, name) = choose(&instance, &surfaces, surface, options.device.as_deref())?;
            let device = device(&instance, physical, family)?;
            made.push(&device, |device| device.destroy_device(None));
            let queue = device.get_device_queue(family, 0);
            let description = AllocatorCreateDesc {
                instance: instance.clone(),
                device: device.clone(),
                physical_device: physical,
                debug_settings: Default::default(),
                buffer_device_address: false,
                allocation_sizes: Default::default(),
            };
            let allocator = Allocator::new(&description).map_err(|e| ViewError::Memory(e.to_string()))?;
            let create = vk::CommandPoolCreateInfo::default()
                .queue_family_index(family)
                .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
            let pool = device.create_command_pool(&create, None)?;
            made.push(&device, move |device| device.destroy_command_pool(pool, None));
            let allocate = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
            let cmd = device.allocate_command_buffers(&allocate)?[0];
            let fence = device.create_fence(&vk::FenceCreateInfo::default(), None)?;
            made.push(&device, move |device| device.destroy_fence(fence, None));
            let acquired = device.create_semaphore(&vk::SemaphoreCreateInfo::default(), None)?;
            made.keep();
            Ok(Self {
                swapchains: ash::khr::swapchain::Device::new(&instance, &device),
                push_descriptor: ash::khr::push_descriptor::Device::new(&instance, &device),
                entry,
                instance,
                debug,
                messages,
                surfaces,
                surface,
                physical,
                device,
                family,
                queue,
                allocator: ManuallyDrop::new(Arc::new(Mutex::new(allocator))),
                pool,
                cmd,
                fence,
                acquired,
                name,
            })
        }
    }

    /// The device, lent to the engine.
    pub fn lend(&self) -> HostDevice {
        HostDevice {
            instance: self.instance.clone(),
            physical: self.physical,
            device: self.device.clone(),
            queue_family: self.family,
            allocator: Arc::new(GpuAllocator::new(Arc::clone(&self.allocator))),
            debug_names: self.debug.is_some(),
            pipeline_statistics: false,
            pipeline_cache: vk::PipelineCache::null(),
            memory_budget: None,
        }
    }

    /// The allocator that all share.
    pub fn allocator(&self) -> &Arc<Mutex<Allocator>> {
        &self.allocator
    }

    /// Frees the surface, whose swapchain is gone.
    pub fn drop_surface(&mut self) {
        // SAFETY: nothing uses it any more. A null handle is ignored: it is not destroyed twice.
        unsafe { self.surfaces.destroy_surface(std::mem::take(&mut self.surface), None) };
    }

    /// Makes a surface where there is none.
    pub fn make_surface(&mut self, window: &Window) -> Result<(), ViewError> {
        // SAFETY: the window is alive.
        self.surface = unsafe { surface(&self.entry, &self.instance, window) }?;
        Ok(())
    }

    /// The validation layer's messages so far.
    pub fn messages(&self) -> Vec<String> {
        self.messages.lock().unwrap_or_else(PoisonError::into_inner).clone()
    }

    /// Waits until the device is idle. A lost device is idle.
    pub fn wait(&self) {
        // SAFETY: the device is alive; nothing is submitted meanwhile by another thread.
        if let Err(error) = unsafe { self.device.device_wait_idle() } {
            tracing::warn!("vkDeviceWaitIdle: {error}");
        }
    }

    /// Destroys everything; returns all messages of the validation layer.
    ///
    /// Objects made from the device were destroyed before.
    pub fn shutdown(mut self) -> Vec<String> {
        self.wait();
        // SAFETY: nothing is in flight; in the order of their dependence, each once.
        unsafe {
            self.device.destroy_semaphore(self.acquired, None);
            self.device.destroy_fence(self.fence, None);
            self.device.destroy_command_pool(self.pool, None);
            ManuallyDrop::drop(&mut self.allocator);
            self.device.destroy_device(None);
            self.surfaces.destroy_surface(self.surface, None);
            if let Some((debug, messenger)) = self.debug.take() {
                debug.destroy_debug_utils_messenger(messenger, None);
            }
            self.instance.destroy_instance(None);
        }
        self.messages()
    }
}

unsafe fn surface(entry: &ash::Entry, instance: &ash::Instance, window: &Window) -> Result<vk::SurfaceKHR, ViewError> {
    let display = window.display_handle().map_err(|e| ViewError::Window(e.to_string()))?.as_raw();
    let handle = window.window_handle().map_err(|e| ViewError::Window(e.to_string()))?.as_raw();
    // SAFETY: the caller's promise: the window is alive.
    Ok(unsafe { ash_window::create_surface(entry, instance, display, handle, None) }?)
}

unsafe fn messenger(
    entry: &ash::Entry,
    instance: &ash::Instance,
    messages: &Arc<Mutex<Vec<String>>>,
) -> Result<(ash::ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT), ViewError> {
    use vk::{DebugUtilsMessageSeverityFlagsEXT as Severity, DebugUtilsMessageTypeFlagsEXT as Type};
    let create = vk::DebugUtilsMessengerCreateInfoEXT::default()
        .message_severity(Severity::WARNING | Severity::ERROR)
        .message_type(Type::VALIDATION)
        .pfn_user_callback(Some(on_message))
        .user_data(Arc::as_ptr(messages).cast_mut().cast());
    let debug = ash::ext::debug_utils::Instance::new(entry, instance);
    // SAFETY: the caller's promise: the messages outlive the instance.
    let messenger = unsafe { debug.create_debug_utils_messenger(&create, None) }?;
    Ok((debug, messenger))
}

/// The device, its queue family and its name.
unsafe fn choose(
    instance: &ash::Instance,
    surfaces: &ash::khr::surface::Instance,
    surface: vk::SurfaceKHR,
    wanted: Option<&str>,
) -> Result<(vk::PhysicalDevice, u32, String), ViewError> {
    let (mut usable, mut unfit) = (Vec::new(), Vec::new());
    // SAFETY: all belongs to the instance, which was made for Vulkan 1.3.
    for physical in unsafe { instance.enumerate_physical_devices() }? {
        let properties = unsafe { instance.get_physical_device_properties(physical) };
        let name = properties.device_name_as_c_str().unwrap_or(c"?").to_string_lossy().into_owned();
        if wanted.is_some_and(|wanted| !name.to_lowercase().contains(&wanted.to_lowercase())) {
            continue;
        }
        let mut missing = unsafe { Requirements::missing(instance, physical) };
        let extensions = unsafe { instance.enumerate_device_extension_properties(physical) }?;
        if !extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(ash::khr::swapchain::NAME)) {
            missing.push("extension VK_KHR_swapchain".to_owned());
        }
        let family = unsafe { Requirements::queue_family(instance, physical) };
        let presents = family.map(|f| unsafe { surfaces.get_physical_device_surface_support(physical, f, surface) });
        match (family, presents) {
            (Some(family), Some(Ok(true))) if missing.is_empty() => {
                let rank = match properties.device_type {
                    vk::PhysicalDeviceType::DISCRETE_GPU => 0,
                    vk::PhysicalDeviceType::INTEGRATED_GPU => 1,
                    vk::PhysicalDeviceType::VIRTUAL_GPU => 2,
                    _ => 3,
                };
                usable.push((rank, physical, family, name));
            }
            _ if missing.is_empty() => unfit.push(format!("{name} does not present to this window")),
            _ => unfit.push(format!("{name} lacks {}", missing.join(", "))),
        }
    }
    let best = usable.into_iter().min_by_key(|(rank, ..)| *rank);
    best.map(|(_, physical, family, name)| (physical, family, name))
        .ok_or_else(|| ViewError::NoDevice(unfit.join("; ")))
}

unsafe fn device(
    instance: &ash::Instance,
    physical: vk::PhysicalDevice,
    family: u32,
) -> Result<ash::Device, ViewError> {
    let (mut core, mut v12, mut v13) = Default::default();
    Requirements::add_to(&mut core, &mut v12, &mut v13);
    let extensions = Requirements::DEVICE_EXTENSIONS.iter().copied().chain([ash::khr::swapchain::NAME]);
    let extensions: Vec<_> = extensions.map(CStr::as_ptr).collect();
    let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
    let create = vk::DeviceCreateInfo::default()
        .queue_create_infos(&queues)
        .enabled_extension_names(&extensions)
        .enabled_features(&core)
        .push_next(&mut v12)
        .push_next(&mut v13);
    // SAFETY: the device suits; the chain outlives the call.
    Ok(unsafe { instance.create_device(physical, &create, None) }?)
}

unsafe extern "system" fn on_message(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user_data: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the address given to `messenger`, and Vulkan's own data.
    let (messages, text) =
        unsafe { (&*user_data.cast::<Mutex<Vec<String>>>(), CStr::from_ptr((*data).p_message).to_string_lossy()) };
    messages.lock().unwrap_or_else(PoisonError::into_inner).push(text.into_owned());
    vk::FALSE
}

#[cfg(test)]
mod tests;
