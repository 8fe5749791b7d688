//! What an engine owns before it meets the renderer: instance, device, allocator, command buffers, fences and a picture.

use super::picture::{RANGE, picture};
use selvedge::ash::{self, vk};
use selvedge::gpu::{GpuAllocator, HostDevice, Image, Requirements};
use selvedge::gpu_allocator::vulkan::{Allocator, AllocatorCreateDesc};
use std::error::Error;
use std::sync::{Arc, Mutex};
use vk::{AccessFlags2 as A, PipelineStageFlags2 as S};

pub const SLOTS: usize = 2;

/// Lives as long as the process: an engine that ends earlier destroys what it made.
pub struct Engine {
    _entry: ash::Entry,
    instance: ash::Instance,
    physical: vk::PhysicalDevice,
    family: u32,
    pub device: ash::Device,
    queue: vk::Queue,
    pub allocator: Arc<Mutex<Allocator>>,
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
        HostDevice {
            instance: self.instance.clone(),
            physical: self.physical,
            device: self.device.clone(),
            queue_family: self.family,
            allocator: Arc::new(GpuAllocator::new(Arc::clone(&self.allocator))),
            debug_names: false,
            pipeline_statistics: false,
            pipeline_cache: vk::PipelineCache::null(),
            memory_budget: None,
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
