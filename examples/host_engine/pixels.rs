//! The picture in host memory: for a test or a screenshot, not for every frame.

use super::picture::RANGE;
use super::vulkan::Engine;
use selvedge::ash::vk;
use selvedge::gpu_allocator::MemoryLocation;
use selvedge::gpu_allocator::vulkan::{AllocationCreateDesc, AllocationScheme};
use std::error::Error;
use vk::{AccessFlags2 as A, ImageLayout as L, PipelineStageFlags2 as S};

/// The pixels after the frame that was submitted last, row 0 on top: sRGB and opacity.
pub fn pixels(engine: &Engine) -> Result<Vec<[u8; 4]>, Box<dyn Error>> {
    let (device, image, (width, height)) = (&engine.device, engine.colour.handle(), engine.colour.size());
    let bytes = width as usize * height as usize * 4;
    let create = vk::BufferCreateInfo::default().size(bytes as u64).usage(vk::BufferUsageFlags::TRANSFER_DST);
    let layers = vk::ImageSubresourceLayers::default().aspect_mask(RANGE.aspect_mask).layer_count(1);
    let region = vk::BufferImageCopy::default().image_subresource(layers);
    let region = region.image_extent(vk::Extent3D { width, height, depth: 1 });
    let drawn = vk::ImageMemoryBarrier2::default().image(image).subresource_range(RANGE);
    let drawn = drawn.src_stage_mask(S::COLOR_ATTACHMENT_OUTPUT).src_access_mask(A::COLOR_ATTACHMENT_WRITE);
    let drawn = drawn.dst_stage_mask(S::COPY).dst_access_mask(A::TRANSFER_READ);
    let drawn = [drawn.old_layout(L::COLOR_ATTACHMENT_OPTIMAL).new_layout(L::TRANSFER_SRC_OPTIMAL)];
    let copied = vk::MemoryBarrier2::default().src_stage_mask(S::COPY).src_access_mask(A::TRANSFER_WRITE);
    let copied = [copied.dst_stage_mask(S::HOST).dst_access_mask(A::HOST_READ)];
    // SAFETY: the buffer has room for the picture, and the copy has ended when its memory is read and freed.
    unsafe {
        let buffer = device.create_buffer(&create, None)?;
        let request = AllocationCreateDesc {
            name: "pixels",
            requirements: device.get_buffer_memory_requirements(buffer),
            location: MemoryLocation::GpuToCpu,
            linear: true,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        };
        let memory = engine.allocator.lock().map_err(|_| "another thread failed")?.allocate(&request)?;
        device.bind_buffer_memory(buffer, memory.memory(), memory.offset())?;
        engine.wait(0)?;
        let cmd = engine.begin(0)?;
        device.cmd_pipeline_barrier2(cmd, &vk::DependencyInfo::default().image_memory_barriers(&drawn));
        device.cmd_copy_image_to_buffer(cmd, image, L::TRANSFER_SRC_OPTIMAL, buffer, &[region]);
        device.cmd_pipeline_barrier2(cmd, &vk::DependencyInfo::default().memory_barriers(&copied));
        engine.submit(0)?;
        engine.wait(0)?;
        let mapped = memory.mapped_slice().ok_or("the memory is not the host's")?;
        let pixels = mapped[..bytes].chunks_exact(4).map(|p| [p[0], p[1], p[2], p[3]]).collect();
        device.destroy_buffer(buffer, None);
        engine.allocator.lock().map_err(|_| "another thread failed")?.free(memory)?;
        Ok(pixels)
    }
}
