//! The picture that an engine draws into: an image and its memory.

use selvedge::ash::{self, vk};
use selvedge::gpu::Image;
use selvedge::gpu_allocator::MemoryLocation;
use selvedge::gpu_allocator::vulkan::{AllocationCreateDesc, AllocationScheme, Allocator};
use std::error::Error;

pub const FORMAT: vk::Format = vk::Format::R8G8B8A8_SRGB;

pub const RANGE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

/// The image that is drawn into.
///
/// # Safety
/// The device is alive, and the allocator is of this device.
pub unsafe fn picture(
    device: &ash::Device,
    allocator: &mut Allocator,
    size: (u32, u32),
) -> Result<Image, Box<dyn Error>> {
    let create = vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(FORMAT)
        .extent(vk::Extent3D { width: size.0, height: size.1, depth: 1 })
        .mip_levels(1)
        .array_layers(1)
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(vk::ImageUsageFlags::COLOR_ATTACHMENT | vk::ImageUsageFlags::TRANSFER_SRC);
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
