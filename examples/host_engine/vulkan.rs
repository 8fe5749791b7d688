//! What an engine owns before it meets the renderer: instance, device, allocator, command buffers, fences and a picture.

use selvedge::ash::{self, vk};
use selvedge::gpu::{GpuAllocator, HostDevice, Image, Requirements};
use selvedge::gpu_allocator::MemoryLocation;
use selvedge::gpu_allocator::vulkan::{AllocationCreateDesc, AllocationScheme, Allocator, AllocatorCreateDesc};
use std::error::Error;
use std::sync::{Arc, Mutex};
use vk::{AccessFlags2 as A, PipelineStageFlags2 as S};

pub const SLOTS: usize = 2;
pub const FORMAT: vk::Format = vk::Format::R8G8B8A8_SRGB;

/// Lives as long as the process: an engine that ends earlier destroys what it made.
pub struct Engine {
    _entry: ash::Entry,
    instance: ash::Instance,
    physical: vk::PhysicalDevice,
    family: u32,
    pub device: ash::Device,
    queue: vk::Queue,
    allocator: Arc<Mutex<Allocator>>,
    commands: Vec<vk::CommandBuffer>,
    fences: [vk::Fence; SLOTS],
    pub colour: Image,
}

impl Engine {
    pub fn new(size: (u32, u32)) -> Result<Self, Box<dyn Error>> {
        // SAFETY: plain Vulkan in its usual order; every struct outlives the call that it is given to.
        unsafe {
            let entry = ash::Entry::load()?;
            let app = vk::ApplicationInfo::default().api_version(Requirements::API_VERSION);
            let instance = entry.create_instance(&vk::InstanceCreateInfo::default().application_info(&app), None)?;
            let suits = |p: &vk::PhysicalDevice| Requirements::missing(&instance, *p).is_empty();
            let physical =
                instance.enumerate_physical_devices()?.into_iter().find(suits).ok_or("no device suffices")?;
            let family = Requirements::queue_family(&instance, physical).ok_or("no queue suffices")?;
            let (mut core, mut v12, mut v13) = Default::default();
            Requirements::add_to(&mut core, &mut v12, &mut v13);
            let queues = [vk::DeviceQueueCreateInfo::default().queue_family_index(family).queue_priorities(&[1.0])];
            let extensions: Vec<_> = Requirements::DEVICE_EXTENSIONS.iter().map(|name| name.as_ptr()).collect();
            let create = vk::DeviceCreateInfo::default().queue_create_infos(&queues).enabled_features(&core);
            let create = create.enabled_extension_names(&extensions).push_next(&mut v12).push_next(&mut v13);
            let device = instance.create_device(physical, &create, None)?;
            let queue = device.get_device_queue(family, 0);
            let mut allocator = Allocator::new(&AllocatorCreateDesc {
                instance: instance.clone(),
                device: device.clone(),
                physical_device: physical,
                debug_settings: Default::default(),
                buffer_device_address: false,
                allocation_sizes: Default::default(),
            })?;
            let colour = picture(&device, &mut allocator, size)?;
            let reset = vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER;
            let create = vk::CommandPoolCreateInfo::default().queue_family_index(family).flags(reset);
            let pool = device.create_command_pool(&create, None)?;
            let create = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(SLOTS as u32);
            let commands = device.allocate_command_buffers(&create)?;
            let signaled = vk::FenceCreateInfo::default().flags(vk::FenceCreateFlags::SIGNALED);
            let fences = [device.create_fence(&signaled, None)?, device.create_fence(&signaled, None)?];
            let allocator = Arc::new(Mutex::new(allocator));
            Ok(Self { _entry: entry, instance, physical, family, device, queue, allocator, commands, fences, colour })
        }
    }

    /// What the renderer borrows.
    pub fn lend(&self) -> HostDevice {
        let (instance, device) = (self.instance.clone(), self.device.clone());
        let allocator = Arc::new(GpuAllocator::new(Arc::clone(&self.allocator)));
        let (debug_names, pipeline_statistics) = (false, false);
        let (physical, queue_family) = (self.physical, self.family);
        let (pipeline_cache, memory_budget) = (vk::PipelineCache::null(), None);
        HostDevice {
            instance,
            physical,
            device,
            queue_family,
            allocator,
            debug_names,
            pipeline_statistics,
            pipeline_cache,
            memory_budget,
        }
    }

    pub fn wait(&self, slot: usize) -> Result<(), vk::Result> {
        // SAFETY: the fence is alive.
        unsafe { self.device.wait_for_fences(&[self.fences[slot]], true, u64::MAX) }
    }

    pub fn begin(&self, slot: usize) -> Result<vk::CommandBuffer, vk::Result> {
        let begin = vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the slot was waited for.
        unsafe { self.device.begin_command_buffer(self.commands[slot], &begin) }.map(|()| self.commands[slot])
    }

    pub fn submit(&self, slot: usize) -> Result<(), vk::Result> {
        let commands = [vk::CommandBufferSubmitInfo::default().command_buffer(self.commands[slot])];
        let submit = vk::SubmitInfo2::default().command_buffer_infos(&commands);
        // SAFETY: the command buffer is recording, its fence signaled.
        unsafe {
            self.device.end_command_buffer(self.commands[slot])?;
            self.device.reset_fences(&[self.fences[slot]])?;
            self.device.queue_submit2(self.queue, &[submit], self.fences[slot])
        }
    }

    /// Drawing into the picture before comes before drawing next; `layout` is the one before.
    pub fn order_drawing(&self, cmd: vk::CommandBuffer, layout: vk::ImageLayout) {
        let (stage, access) = (S::COLOR_ATTACHMENT_OUTPUT, A::COLOR_ATTACHMENT_READ | A::COLOR_ATTACHMENT_WRITE);
        let barrier = vk::ImageMemoryBarrier2::default().image(self.colour.handle()).subresource_range(RANGE);
        let barrier =
            barrier.src_stage_mask(stage).src_access_mask(access).dst_stage_mask(stage).dst_access_mask(access);
        let barriers = [barrier.old_layout(layout).new_layout(vk::ImageLayout::COLOR_ATTACHMENT_OPTIMAL)];
        // SAFETY: recording outside rendering.
        unsafe {
            self.device.cmd_pipeline_barrier2(cmd, &vk::DependencyInfo::default().image_memory_barriers(&barriers))
        };
    }
}

const RANGE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

/// The image that is drawn into.
unsafe fn picture(device: &ash::Device, allocator: &mut Allocator, size: (u32, u32)) -> Result<Image, Box<dyn Error>> {
    let create = vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(FORMAT)
        .extent(vk::Extent3D { width: size.0, height: size.1, depth: 1 })
        .mip_levels(1)
        .array_layers(1)
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(vk::ImageUsageFlags::COLOR_ATTACHMENT);
    // SAFETY: the device is alive; the memory is bound before the view is made.
    unsafe {
        let image = device.create_image(&create, None)?;
        let memory = allocator.allocate(&AllocationCreateDesc {
            name: "picture",
            requirements: device.get_image_memory_requirements(image),
            location: MemoryLocation::GpuOnly,
            linear: false,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        })?;
        device.bind_image_memory(image, memory.memory(), memory.offset())?;
        let view = vk::ImageViewCreateInfo::default().image(image).subresource_range(RANGE);
        let view = view.view_type(vk::ImageViewType::TYPE_2D).format(FORMAT);
        Ok(Image::borrowed("picture", image, device.create_image_view(&view, None)?, size, FORMAT))
    }
}
