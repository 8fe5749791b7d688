//! Images that the engine draws into, and the buffer that a few of their pixels are copied to.
//!
//! ```text
//!   engine ──▶ colour, depth, face, (u, v), normal, edge, part, instance ──▶ composite: the window
//!                                   └── pixels around the cursor ──▶ PickBuffer ──▶ the item under it
//! ```
//!
//! The images of the shown picture are kept, so a pick draws nothing: it costs the same for every model.

use super::ViewError;
use super::context::Context;
use crate::pick::snap::SNAP_PX;
use crate::pick::{Sample, Samples};
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use selvedge::gpu::Image;
use selvedge::picture::Outputs;
use selvedge::renderer::{Aovs, TargetFormats, Targets as EngineTargets};
use selvedge::{ash, gpu_allocator};
use std::sync::PoisonError;
use vk::{AccessFlags2 as A, ImageLayout as L, PipelineStageFlags2 as S};

/// As the engine's own pictures have it: encoded by the format.
pub const COLOUR_FORMAT: vk::Format = vk::Format::R8G8B8A8_SRGB;
/// What the engine draws into.
pub const FORMATS: TargetFormats = TargetFormats {
    colour: COLOUR_FORMAT,
    depth: None,
    outputs: Outputs { edge: true, part: true, instance: true, ..Outputs::ALL },
};
const COUNT: usize = 8;

/// One side of a barrier.
type Use = (S, A, L);
const DRAWN: Use = (
    S::COLOR_ATTACHMENT_OUTPUT,
    A::from_raw(A::COLOR_ATTACHMENT_READ.as_raw() | A::COLOR_ATTACHMENT_WRITE.as_raw()),
    L::COLOR_ATTACHMENT_OPTIMAL,
);
/// Sampled by the composite pass and copied from.
const READ: Use = (
    S::from_raw(S::FRAGMENT_SHADER.as_raw() | S::ALL_TRANSFER.as_raw()),
    A::from_raw(A::SHADER_SAMPLED_READ.as_raw() | A::TRANSFER_READ.as_raw()),
    L::GENERAL,
);

/// The engine's images of one size.
pub struct Targets {
    images: [(vk::Image, vk::ImageView, Allocation); COUNT],
    /// The same as the engine takes them: colour; depth, face, (u, v), normal; edge, part, instance.
    borrowed: [Image; COUNT],
}

const NAMES: [&str; COUNT] = ["colour", "depth", "face", "uv", "normal", "edge", "part", "instance"];

fn formats() -> [vk::Format; COUNT] {
    use vk::Format as F;
    let number = F::R32_UINT;
    [COLOUR_FORMAT, F::R32_SFLOAT, number, F::R32G32_SFLOAT, F::R32G32B32A32_SFLOAT, number, number, number]
}

const WHOLE: vk::ImageSubresourceRange = vk::ImageSubresourceRange {
    aspect_mask: vk::ImageAspectFlags::COLOR,
    base_mip_level: 0,
    level_count: 1,
    base_array_layer: 0,
    layer_count: 1,
};

impl Targets {
    /// Images of this size without contents. If one of them fails, none is left.
    pub fn new(context: &Context, size: (u32, u32)) -> Result<Self, ViewError> {
        let mut made = Vec::with_capacity(COUNT);
        for (name, format) in NAMES.into_iter().zip(formats()) {
            match image(context, name, size, format) {
                Ok(image) => made.push(image),
                Err(error) => {
                    made.into_iter().for_each(|image| free(context, image));
                    return Err(error);
                }
            }
        }
        let Ok(images) = <[_; COUNT]>::try_from(made) else { unreachable!("one for each name") };
        let borrowed = std::array::from_fn(|i| {
            // SAFETY: the view shows all of the image, and both live as long as this value.
            unsafe { Image::borrowed(NAMES[i], images[i].0, images[i].1, size, formats()[i]) }
        });
        Ok(Self { images, borrowed })
    }

    /// Width and height.
    pub fn size(&self) -> (u32, u32) {
        self.borrowed[0].size()
    }

    /// Views for the composite pass: colour, face, instance.
    pub fn views(&self) -> [vk::ImageView; 3] {
        [0, 2, 7].map(|i| self.images[i].1)
    }

    /// For the engine.
    pub fn engine(&self) -> EngineTargets<'_> {
        let [colour, rest @ ..] = &self.borrowed;
        let [depth, face, uv, normal, edge, part, instance] = rest.each_ref().map(Some);
        let aovs = Aovs { depth, face, uv, normal, edge, part, instance };
        EngineTargets { aovs, ..EngineTargets::new(colour) }
    }

    /// Makes them attachments for the engine; their old contents are discarded.
    pub fn begin(&self, context: &Context) {
        self.barriers(context, (READ.0, A::NONE, L::UNDEFINED), DRAWN);
    }

    /// The composite pass and copies may read.
    pub fn end(&self, context: &Context) {
        self.barriers(context, DRAWN, READ);
    }

    fn barriers(&self, context: &Context, before: Use, after: Use) {
        let barriers = self.images.each_ref().map(|(image, ..)| barrier(*image, before, after));
        record_barriers(context, &barriers);
    }

    /// Copies the pixels of `around` to the buffer.
    pub fn copy(&self, context: &Context, to: &PickBuffer, around: Area) {
        let images = (1..COUNT).map(|i| (i, BYTES[i - 1]));
        self.copy_area(context, to.buffer, images, around);
    }

    /// Copies whole images, by their numbers and bytes of a pixel, to a buffer with room for them.
    pub fn copy_all(&self, context: &Context, to: vk::Buffer, images: impl IntoIterator<Item = (usize, u64)>) {
        let (width, height) = self.size();
        self.copy_area(context, to, images, Area { x: 0, y: 0, width, height });
    }

    fn copy_area(&self, context: &Context, to: vk::Buffer, images: impl IntoIterator<Item = (usize, u64)>, area: Area) {
        let mut offset = 0;
        for (i, bytes) in images {
            let layers = vk::ImageSubresourceLayers::default().aspect_mask(vk::ImageAspectFlags::COLOR).layer_count(1);
            let region = vk::BufferImageCopy::default()
                .buffer_offset(offset)
                .image_subresource(layers)
                .image_offset(vk::Offset3D { x: area.x as i32, y: area.y as i32, z: 0 })
                .image_extent(vk::Extent3D { width: area.width, height: area.height, depth: 1 });
            let image = self.images[i].0;
            // SAFETY: recording; the area lies in the image, and the buffer has room for it.
            unsafe { context.device.cmd_copy_image_to_buffer(context.cmd, image, L::GENERAL, to, &[region]) };
            offset += bytes * u64::from(area.width) * u64::from(area.height);
        }
        let host = [vk::MemoryBarrier2::default()
            .src_stage_mask(S::ALL_TRANSFER)
            .src_access_mask(A::TRANSFER_WRITE)
            .dst_stage_mask(S::HOST)
            .dst_access_mask(A::HOST_READ)];
        // SAFETY: recording.
        unsafe {
            context.device.cmd_pipeline_barrier2(context.cmd, &vk::DependencyInfo::default().memory_barriers(&host));
        }
    }

    /// Frees them; the GPU has finished with them.
    pub fn destroy(self, context: &Context) {
        self.images.into_iter().for_each(|image| free(context, image));
    }
}

/// A rectangle of pixels within a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    pub x: u32,
    pub y: u32,
    pub width: u32,
    pub height: u32,
}

/// Pixels beside the cursor that are copied: points are found within a pixel less.
const REACH: u32 = SNAP_PX as u32 + 1;
const SIDE: u32 = 2 * REACH + 1;
/// Of a pixel: depth, face, (u, v), normal, edge, part, instance.
const BYTES: [u64; COUNT - 1] = [4, 4, 8, 16, 4, 4, 4];

impl Area {
    /// The pixels around one, as far as there are any.
    pub fn around((x, y): (u32, u32), size: (u32, u32)) -> Self {
        let (left, top) = (x.saturating_sub(REACH), y.saturating_sub(REACH));
        let (right, bottom) = ((x + REACH + 1).min(size.0), (y + REACH + 1).min(size.1));
        Self { x: left, y: top, width: right - left, height: bottom - top }
    }
}

/// The buffer for pixels around the cursor.
pub struct PickBuffer {
    buffer: vk::Buffer,
    memory: Allocation,
}

impl PickBuffer {
    pub fn new(context: &Context) -> Result<Self, ViewError> {
        let bytes = BYTES.iter().sum::<u64>() * u64::from(SIDE * SIDE);
        let (buffer, memory) =
            buffer(context, "pick", bytes, vk::BufferUsageFlags::TRANSFER_DST, MemoryLocation::GpuToCpu)?;
        Ok(Self { buffer, memory })
    }

    /// The copied pixels of `around`, after the fence.
    pub fn samples(&self, around: Area) -> Samples {
        let bytes = self.memory.mapped_slice().unwrap_or_default();
        let count = (around.width * around.height) as usize;
        let mut starts = [0; COUNT - 1];
        for i in 1..starts.len() {
            starts[i] = starts[i - 1] + BYTES[i - 1] as usize * count;
        }
        let word = |image: usize, pixel: usize, component: usize| {
            let at = starts[image] + pixel * BYTES[image] as usize + 4 * component;
            bytes.get(at..at + 4).and_then(|b| b.try_into().ok()).map_or(0, u32::from_ne_bytes)
        };
        let float = |image, pixel, component| f32::from_bits(word(image, pixel, component));
        let sample = |pixel: usize| Sample {
            depth: float(0, pixel, 0),
            face: word(1, pixel, 0),
            uv: [float(2, pixel, 0), float(2, pixel, 1)],
            normal: [0, 1, 2].map(|c| float(3, pixel, c)),
            edge: word(4, pixel, 0),
            part: word(5, pixel, 0),
            instance: word(6, pixel, 0),
        };
        Samples { corner: (around.x, around.y), width: around.width, samples: (0..count).map(sample).collect() }
    }

    pub fn destroy(self, context: &Context) {
        free_buffer(context, (self.buffer, self.memory));
    }
}

pub fn barrier(image: vk::Image, before: Use, after: Use) -> vk::ImageMemoryBarrier2<'static> {
    vk::ImageMemoryBarrier2::default()
        .src_stage_mask(before.0)
        .src_access_mask(before.1)
        .dst_stage_mask(after.0)
        .dst_access_mask(after.1)
        .old_layout(before.2)
        .new_layout(after.2)
        .image(image)
        .subresource_range(WHOLE)
}

pub fn record_barriers(context: &Context, barriers: &[vk::ImageMemoryBarrier2<'_>]) {
    let dependency = vk::DependencyInfo::default().image_memory_barriers(barriers);
    // SAFETY: recording outside rendering; the images are alive.
    unsafe { context.device.cmd_pipeline_barrier2(context.cmd, &dependency) };
}

fn allocate(
    context: &Context,
    name: &str,
    requirements: vk::MemoryRequirements,
    location: MemoryLocation,
) -> Result<Allocation, ViewError> {
    let linear = location != MemoryLocation::GpuOnly;
    let allocation_scheme = AllocationScheme::GpuAllocatorManaged;
    let description = AllocationCreateDesc { name, requirements, location, linear, allocation_scheme };
    let mut allocator = context.allocator().lock().unwrap_or_else(PoisonError::into_inner);
    allocator.allocate(&description).map_err(|e| ViewError::Memory(format!("{name}: {e}")))
}

fn image(
    context: &Context,
    name: &str,
    size: (u32, u32),
    format: vk::Format,
) -> Result<(vk::Image, vk::ImageView, Allocation), ViewError> {
    use vk::ImageUsageFlags as U;
    let create = vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(format)
        .extent(vk::Extent3D { width: size.0, height: size.1, depth: 1 })
        .mip_levels(1)
        .array_layers(1)
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(U::COLOR_ATTACHMENT | U::SAMPLED | U::TRANSFER_SRC);
    // SAFETY: the device is alive; memory is bound before the view is made.
    unsafe {
        let image = context.device.create_image(&create, None)?;
        let requirements = context.device.get_image_memory_requirements(image);
        let memory = allocate(context, name, requirements, MemoryLocation::GpuOnly)
            .inspect_err(|_| context.device.destroy_image(image, None))?;
        let view = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(format)
            .subresource_range(WHOLE);
        let bound = context.device.bind_image_memory(image, memory.memory(), memory.offset());
        match bound.and_then(|()| context.device.create_image_view(&view, None)) {
            Ok(view) => Ok((image, view, memory)),
            Err(error) => {
                free(context, (image, vk::ImageView::null(), memory));
                Err(error.into())
            }
        }
    }
}

fn free(context: &Context, (image, view, memory): (vk::Image, vk::ImageView, Allocation)) {
    // SAFETY: the GPU has finished with it.
    unsafe {
        context.device.destroy_image_view(view, None);
        context.device.destroy_image(image, None);
    }
    release(context, memory);
}

fn release(context: &Context, memory: Allocation) {
    let mut allocator = context.allocator().lock().unwrap_or_else(PoisonError::into_inner);
    if let Err(error) = allocator.free(memory) {
        tracing::error!("{error}");
    }
}

/// A buffer with memory that the CPU reads or writes. If a step fails, nothing is left of it.
pub fn buffer(
    context: &Context,
    name: &str,
    bytes: u64,
    usage: vk::BufferUsageFlags,
    location: MemoryLocation,
) -> Result<(vk::Buffer, Allocation), ViewError> {
    let create = vk::BufferCreateInfo::default().size(bytes).usage(usage);
    // SAFETY: the device is alive.
    unsafe {
        let buffer = context.device.create_buffer(&create, None)?;
        let requirements = context.device.get_buffer_memory_requirements(buffer);
        let memory = allocate(context, name, requirements, location)
            .inspect_err(|_| context.device.destroy_buffer(buffer, None))?;
        match context.device.bind_buffer_memory(buffer, memory.memory(), memory.offset()) {
            Ok(()) => Ok((buffer, memory)),
            Err(error) => {
                free_buffer(context, (buffer, memory));
                Err(error.into())
            }
        }
    }
}

/// Frees a buffer; the GPU has finished with it.
pub fn free_buffer(context: &Context, (buffer, memory): (vk::Buffer, Allocation)) {
    // SAFETY: the GPU has finished with it.
    unsafe { context.device.destroy_buffer(buffer, None) };
    release(context, memory);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pixels_around_one_lie_in_the_picture() {
        let area = |x, y, width, height| Area { x, y, width, height };
        assert_eq!(Area::around((50, 60), (100, 100)), area(42, 52, 17, 17));
        assert_eq!(Area::around((0, 0), (100, 100)), area(0, 0, 9, 9));
        assert_eq!(Area::around((99, 98), (100, 100)), area(91, 90, 9, 10));
        assert_eq!(Area::around((0, 0), (1, 1)), area(0, 0, 1, 1));
    }
}
