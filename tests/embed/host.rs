//! A host in plain ash, with everything that an engine has before it uses the renderer.

use ash::vk;
use ash::vk::Handle;
use gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use selvedge::gpu::{GpuAllocator, HostDevice, RawDevice, Requirements};
use std::ffi::{CStr, c_void};
use std::mem::ManuallyDrop;
use std::sync::{Arc, Mutex};

/// Frames in flight.
pub const SLOTS: usize = 2;

pub struct Host {
    entry: ash::Entry,
    pub instance: ash::Instance,
    debug: ash::ext::debug_utils::Instance,
    messenger: vk::DebugUtilsMessengerEXT,
    messages: Box<Mutex<Vec<String>>>,
    physical: vk::PhysicalDevice,
    pub device: ash::Device,
    family: u32,
    queue: vk::Queue,
    pub allocator: ManuallyDrop<Arc<Mutex<Allocator>>>,
    pool: vk::CommandPool,
    pub commands: [vk::CommandBuffer; SLOTS],
    fences: [vk::Fence; SLOTS],
}

impl Host {
    pub fn new() -> Self {
        // SAFETY: plain Vulkan in its usual order; every struct outlives the call that it is given to.
        unsafe {
            let entry = ash::Entry::load().expect("these tests need Vulkan: apt install libvulkan1");
            let app = vk::ApplicationInfo::default().api_version(Requirements::API_VERSION);
            let layers = [c"VK_LAYER_KHRONOS_validation".as_ptr()];
            let extensions = [ash::ext::debug_utils::NAME.as_ptr()];
            let mut features = vk::ValidationFeaturesEXT::default()
                .enabled_validation_features(&[vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION]);
            let create = vk::InstanceCreateInfo::default()
                .application_info(&app)
                .enabled_layer_names(&layers)
                .enabled_extension_names(&extensions)
                .push_next(&mut features);
            let instance = entry.create_instance(&create, None).expect("these tests need the validation layers");
            let messages = Box::new(Mutex::new(Vec::new()));
            let severity =
                vk::DebugUtilsMessageSeverityFlagsEXT::WARNING | vk::DebugUtilsMessageSeverityFlagsEXT::ERROR;
            let create = vk::DebugUtilsMessengerCreateInfoEXT::default()
                .message_severity(severity)
                .message_type(vk::DebugUtilsMessageTypeFlagsEXT::VALIDATION)
                .pfn_user_callback(Some(on_message))
                .user_data((&raw const *messages).cast_mut().cast());
            let debug = ash::ext::debug_utils::Instance::new(&entry, &instance);
            let messenger = debug.create_debug_utils_messenger(&create, None).unwrap();

            let all = instance.enumerate_physical_devices().unwrap();
            let suits = |p: &vk::PhysicalDevice| Requirements::missing(&instance, *p).is_empty();
            let physical = all.into_iter().find(suits).expect("a device that the engine runs on");
            let family = Requirements::queue_family(&instance, physical).unwrap();
            let device = Self::device(&instance, physical, family);
            let queue = device.get_device_queue(family, 0);
            let description = AllocatorCreateDesc {
                instance: instance.clone(),
                device: device.clone(),
                physical_device: physical,
                debug_settings: Default::default(),
                buffer_device_address: false,
                allocation_sizes: Default::default(),
            };
            let allocator = Arc::new(Mutex::new(Allocator::new(&description).unwrap()));

            let create = vk::CommandPoolCreateInfo::default()
                .queue_family_index(family)
                .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
            let pool = device.create_command_pool(&create, None).unwrap();
            let allocate =
                vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(SLOTS as u32);
            let commands = device.allocate_command_buffers(&allocate).unwrap().try_into().unwrap();
            let signaled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
            let fences = [(); SLOTS].map(|()| device.create_fence(&signaled, None).unwrap());
            let allocator = ManuallyDrop::new(allocator);
            Self {
                entry,
                instance,
                debug,
                messenger,
                messages,
                physical,
                device,
                family,
                queue,
                allocator,
                pool,
                commands,
                fences,
            }
        }
    }

    /// A device with the host's own features, chained in the host's way, and the engine's added.
    unsafe fn device(instance: &ash::Instance, physical: vk::PhysicalDevice, family: u32) -> ash::Device {
        let mut core = vk::PhysicalDeviceFeatures { shader_int64: vk::TRUE, ..Default::default() };
        let mut v12 = vk::PhysicalDeviceVulkan12Features::default().timeline_semaphore(true);
        let mut v13 = vk::PhysicalDeviceVulkan13Features::default();
        Requirements::add_to(&mut core, &mut v12, &mut v13);
        let mut features =
            vk::PhysicalDeviceFeatures2::default().features(core).push_next(&mut v12).push_next(&mut v13);
        let extensions: Vec<_> = Requirements::DEVICE_EXTENSIONS.iter().map(|name| name.as_ptr()).collect();
        let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
        let create = vk::DeviceCreateInfo::default()
            .queue_create_infos(&queues)
            .enabled_extension_names(&extensions)
            .push_next(&mut features);
        // SAFETY: the device suits; the chain outlives the call.
        unsafe { instance.create_device(physical, &create, None) }.unwrap()
    }

    /// The objects that the renderer borrows.
    pub fn lend(&self) -> HostDevice {
        HostDevice {
            instance: self.instance.clone(),
            physical: self.physical,
            device: self.device.clone(),
            queue_family: self.family,
            allocator: Arc::new(GpuAllocator::new(Arc::clone(&self.allocator))),
            debug_names: true,
            pipeline_statistics: false,
            pipeline_cache: vk::PipelineCache::null(),
            memory_budget: None,
        }
    }

    /// The same as numbers, as a host has them whose bindings are not ash.
    pub fn raw(&self) -> RawDevice {
        RawDevice {
            get_instance_proc_addr: self.entry.static_fn().get_instance_proc_addr as *const c_void,
            instance: self.instance.handle().as_raw(),
            physical: self.physical.as_raw(),
            device: self.device.handle().as_raw(),
            queue_family: self.family,
        }
    }

    /// Waits until the previous frame has left the slot, and begins its command buffer.
    pub fn begin(&self, slot: usize) -> vk::CommandBuffer {
        let cmd = self.commands[slot];
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        self.wait(slot);
        // SAFETY: the command buffer is not in use any more.
        unsafe { self.device.begin_command_buffer(cmd, &begin) }.unwrap();
        cmd
    }

    /// Waits for the slot's fence.
    pub fn wait(&self, slot: usize) {
        // SAFETY: the fence is alive.
        unsafe { self.device.wait_for_fences(&[self.fences[slot]], true, u64::MAX) }.unwrap();
    }

    /// Ends and submits the slot's command buffer; does not wait.
    pub fn submit(&self, slot: usize) {
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.commands[slot])];
        let submit = vk::SubmitInfo2::default().command_buffer_infos(&commands);
        // SAFETY: the command buffer is recording, its fence signaled.
        unsafe {
            self.device.end_command_buffer(self.commands[slot]).unwrap();
            self.device.reset_fences(&[self.fences[slot]]).unwrap();
            self.device.queue_submit2(self.queue, &[submit], self.fences[slot]).unwrap();
        }
    }

    /// Destroys everything; returns all messages of the validation layers.
    pub fn shutdown(mut self) -> Vec<String> {
        // SAFETY: nothing is in flight, and what was made from the device is gone.
        unsafe {
            self.device.device_wait_idle().unwrap();
            self.fences.into_iter().for_each(|fence| self.device.destroy_fence(fence, None));
            self.device.destroy_command_pool(self.pool, None);
            assert_eq!(Arc::strong_count(&self.allocator), 1, "somebody still holds the allocator");
            ManuallyDrop::drop(&mut self.allocator);
            self.device.destroy_device(None);
            self.debug.destroy_debug_utils_messenger(self.messenger, None);
            self.instance.destroy_instance(None);
        }
        self.messages.into_inner().unwrap()
    }
}

unsafe extern "system" fn on_message(
    _: vk::DebugUtilsMessageSeverityFlagsEXT,
    _: vk::DebugUtilsMessageTypeFlagsEXT,
    data: *const vk::DebugUtilsMessengerCallbackDataEXT<'_>,
    user_data: *mut c_void,
) -> vk::Bool32 {
    // SAFETY: the address of the host's messages, and Vulkan's own data.
    let (messages, text) =
        unsafe { (&*user_data.cast::<Mutex<Vec<String>>>(), CStr::from_ptr((*data).p_message).to_string_lossy()) };
    messages.lock().unwrap().push(text.into_owned());
    vk::FALSE
}
