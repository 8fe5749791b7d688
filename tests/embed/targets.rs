//! The host's colour and depth image, its own drawing, and its way to read them.

use crate::host::Host;
use ash::vk;
use gpu_allocator::MemoryLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use selvedge::gpu::Image;
use vk::{AccessFlags2 as A, ImageLayout as L, PipelineStageFlags2 as S};

pub const DEPTH_FORMAT: vk::Format = vk::Format::D32_SFLOAT;

/// One side of a barrier.
type Use = (S, A, L);
const NEW: Use = (S::NONE, A::NONE, L::UNDEFINED);
const COLOUR: Use = (
    S::COLOR_ATTACHMENT_OUTPUT,
    A::from_raw(A::COLOR_ATTACHMENT_READ.as_raw() | A::COLOR_ATTACHMENT_WRITE.as_raw()),
    L::COLOR_ATTACHMENT_OPTIMAL,
);
const DEPTH: Use = (
    S::from_raw(S::EARLY_FRAGMENT_TESTS.as_raw() | S::LATE_FRAGMENT_TESTS.as_raw()),
    A::from_raw(A::DEPTH_STENCIL_ATTACHMENT_READ.as_raw() | A::DEPTH_STENCIL_ATTACHMENT_WRITE.as_raw()),
    L::DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
);
const COPY: Use = (S::ALL_TRANSFER, A::TRANSFER_READ, L::TRANSFER_SRC_OPTIMAL);

/// Images of one size with host-visible copies; destroyed by [`destroy`](Self::destroy).
pub struct Targets {
    pub size: (u32, u32),
    images: [(vk::Image, vk::ImageView, Allocation); 2],
    copies: [(vk::Buffer, Allocation); 2],
    /// The same handles as the renderer's types.
    pub colour: Image,
    pub depth: Image,
}

impl Targets {
    pub fn new(host: &Host, size: (u32, u32), colour: vk::Format) -> Self {
        use vk::ImageUsageFlags as U;
        let images = [
            image(host, size, colour, U::COLOR_ATTACHMENT, vk::ImageAspectFlags::COLOR),
            image(host, size, DEPTH_FORMAT, U::DEPTH_STENCIL_ATTACHMENT, vk::ImageAspectFlags::DEPTH),
        ];
        let copies = [(); 2].map(|()| copy(host, u64::from(size.0) * u64::from(size.1) * 4));
        // SAFETY: the views show the whole images, which the test destroys after the GPU's work.
        let [colour, depth] = [("host colour", colour, 0), ("host depth", DEPTH_FORMAT, 1)]
            .map(|(name, format, i)| unsafe { Image::borrowed(name, images[i].0, images[i].1, size, format) });
        Self { size, images, copies, colour, depth }
    }

    /// Draws the host's own picture: `colour` at depth 0, and boxes `(x, width, depth)` over the whole height that
    /// differ only in depth.
    pub fn draw(&self, host: &Host, cmd: vk::CommandBuffer, colour: [f32; 4], boxes: &[(u32, u32, f32)]) {
        self.barriers(host, cmd, (NEW, COLOUR), (NEW, DEPTH));
        let clear =
            |value| vk::RenderingAttachmentInfo::default().load_op(vk::AttachmentLoadOp::CLEAR).clear_value(value);
        let plain = vk::ClearValue { color: vk::ClearColorValue { float32: colour } };
        let colours = [clear(plain).image_view(self.images[0].1).image_layout(COLOUR.2)];
        let far = vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue::default() };
        let depths = clear(far).image_view(self.images[1].1).image_layout(DEPTH.2);
        self.render(host, cmd, &colours, Some(&depths), || {
            for &(x, width, depth) in boxes {
                let clear_value = vk::ClearValue { depth_stencil: vk::ClearDepthStencilValue { depth, stencil: 0 } };
                let what =
                    vk::ClearAttachment { aspect_mask: vk::ImageAspectFlags::DEPTH, clear_value, ..Default::default() };
                let offset = vk::Offset2D { x: x as i32, y: 0 };
                let extent = vk::Extent2D { width, height: self.size.1 };
                let rect = vk::ClearRect { rect: vk::Rect2D { offset, extent }, layer_count: 1, ..Default::default() };
                // SAFETY: within rendering; the box lies in the images.
                unsafe { host.device.cmd_clear_attachments(cmd, &[what], &[rect]) };
            }
        });
    }

    /// Barriers before the renderer draws.
    pub fn hand_over(&self, host: &Host, cmd: vk::CommandBuffer) {
        self.barriers(host, cmd, (COLOUR, COLOUR), (DEPTH, DEPTH));
    }

    /// The host draws over the picture: a square of `side` pixels in the upper left corner.
    pub fn overlay(&self, host: &Host, cmd: vk::CommandBuffer, side: u32, colour: [f32; 4]) {
        self.hand_over(host, cmd);
        let keep = vk::RenderingAttachmentInfo::default()
            .load_op(vk::AttachmentLoadOp::LOAD)
            .image_view(self.images[0].1)
            .image_layout(COLOUR.2);
        self.render(host, cmd, &[keep], None, || {
            let clear_value = vk::ClearValue { color: vk::ClearColorValue { float32: colour } };
            let what =
                vk::ClearAttachment { aspect_mask: vk::ImageAspectFlags::COLOR, color_attachment: 0, clear_value };
            let rect = vk::Rect2D { extent: vk::Extent2D { width: side, height: side }, ..Default::default() };
            let rect = vk::ClearRect { rect, layer_count: 1, ..Default::default() };
            // SAFETY: within rendering; the box lies in the image.
            unsafe { host.device.cmd_clear_attachments(cmd, &[what], &[rect]) };
        });
    }

    /// Copies both images to where the CPU reads them after the fence.
    pub fn read_back(&self, host: &Host, cmd: vk::CommandBuffer) {
        self.barriers(host, cmd, (COLOUR, COPY), (DEPTH, COPY));
        for (i, aspect) in [vk::ImageAspectFlags::COLOR, vk::ImageAspectFlags::DEPTH].into_iter().enumerate() {
            let layers = vk::ImageSubresourceLayers::default().aspect_mask(aspect).layer_count(1);
            let image_extent = vk::Extent3D { width: self.size.0, height: self.size.1, depth: 1 };
            let region = vk::BufferImageCopy::default().image_subresource(layers).image_extent(image_extent);
            let host_read = vk::MemoryBarrier2::default()
                .src_stage_mask(S::ALL_TRANSFER)
                .src_access_mask(A::TRANSFER_WRITE)
                .dst_stage_mask(S::HOST)
                .dst_access_mask(A::HOST_READ);
            // SAFETY: recording; the buffer has room for the image.
            unsafe {
                host.device.cmd_copy_image_to_buffer(cmd, self.images[i].0, COPY.2, self.copies[i].0, &[region]);
                let barriers = [host_read];
                host.device.cmd_pipeline_barrier2(cmd, &vk::DependencyInfo::default().memory_barriers(&barriers));
            }
        }
    }

    /// Colour and reversed depth, row 0 on top, after the fence.
    pub fn values(&self) -> (Vec<[u8; 4]>, Vec<f32>) {
        let pixels = (self.size.0 * self.size.1) as usize;
        let bytes = |i: usize| &self.copies[i].1.mapped_slice().expect("mapped")[..4 * pixels];
        let words = |i: usize| bytes(i).as_chunks::<4>().0.iter().copied();
        (words(0).collect(), words(1).map(f32::from_ne_bytes).collect())
    }

    pub fn destroy(self, host: &Host) {
        let mut allocator = host.allocator.lock().unwrap();
        // SAFETY: the GPU has finished with all of it.
        unsafe {
            for (image, view, memory) in self.images {
                host.device.destroy_image_view(view, None);
                host.device.destroy_image(image, None);
                allocator.free(memory).unwrap();
            }
            for (buffer, memory) in self.copies {
                host.device.destroy_buffer(buffer, None);
                allocator.free(memory).unwrap();
            }
        }
    }

    fn render(
        &self,
        host: &Host,
        cmd: vk::CommandBuffer,
        colour: &[vk::RenderingAttachmentInfo<'_>],
        depth: Option<&vk::RenderingAttachmentInfo<'_>>,
        record: impl FnOnce(),
    ) {
        let extent = vk::Extent2D { width: self.size.0, height: self.size.1 };
        let area = vk::Rect2D { extent, ..Default::default() };
        let mut info = vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(colour);
        if let Some(depth) = depth {
            info = info.depth_attachment(depth);
        }
        // SAFETY: recording; the images are in the layouts of attachments.
        unsafe { host.device.cmd_begin_rendering(cmd, &info) };
        record();
        // SAFETY: begun above.
        unsafe { host.device.cmd_end_rendering(cmd) };
    }

    fn barriers(&self, host: &Host, cmd: vk::CommandBuffer, colour: (Use, Use), depth: (Use, Use)) {
        let all = [(0, colour, vk::ImageAspectFlags::COLOR), (1, depth, vk::ImageAspectFlags::DEPTH)];
        let barriers = all.map(|(i, (before, after), aspect)| {
            vk::ImageMemoryBarrier2::default()
                .src_stage_mask(before.0)
                .src_access_mask(before.1)
                .dst_stage_mask(after.0)
                .dst_access_mask(after.1)
                .old_layout(before.2)
                .new_layout(after.2)
                .image(self.images[i].0)
                .subresource_range(range(aspect))
        });
        let dependency = vk::DependencyInfo::default().image_memory_barriers(&barriers);
        // SAFETY: recording outside rendering.
        unsafe { host.device.cmd_pipeline_barrier2(cmd, &dependency) };
    }
}

fn range(aspect: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange::default().aspect_mask(aspect).level_count(1).layer_count(1)
}

fn image(
    host: &Host,
    size: (u32, u32),
    format: vk::Format,
    usage: vk::ImageUsageFlags,
    aspect: vk::ImageAspectFlags,
) -> (vk::Image, vk::ImageView, Allocation) {
    let create = vk::ImageCreateInfo::default()
        .image_type(vk::ImageType::TYPE_2D)
        .format(format)
        .extent(vk::Extent3D { width: size.0, height: size.1, depth: 1 })
        .mip_levels(1)
        .array_layers(1)
        .samples(vk::SampleCountFlags::TYPE_1)
        .usage(usage | vk::ImageUsageFlags::TRANSFER_SRC | vk::ImageUsageFlags::TRANSFER_DST);
    // SAFETY: the device is alive; the memory is bound before the view is made.
    unsafe {
        let image = host.device.create_image(&create, None).unwrap();
        let memory = allocate(host, host.device.get_image_memory_requirements(image), MemoryLocation::GpuOnly);
        host.device.bind_image_memory(image, memory.memory(), memory.offset()).unwrap();
        let view = vk::ImageViewCreateInfo::default()
            .image(image)
            .view_type(vk::ImageViewType::TYPE_2D)
            .format(format)
            .subresource_range(range(aspect));
        (image, host.device.create_image_view(&view, None).unwrap(), memory)
    }
}

fn copy(host: &Host, bytes: u64) -> (vk::Buffer, Allocation) {
    let create = vk::BufferCreateInfo::default().size(bytes).usage(vk::BufferUsageFlags::TRANSFER_DST);
    // SAFETY: the device is alive.
    unsafe {
        let buffer = host.device.create_buffer(&create, None).unwrap();
        let memory = allocate(host, host.device.get_buffer_memory_requirements(buffer), MemoryLocation::GpuToCpu);
        host.device.bind_buffer_memory(buffer, memory.memory(), memory.offset()).unwrap();
        (buffer, memory)
    }
}

fn allocate(host: &Host, requirements: vk::MemoryRequirements, location: MemoryLocation) -> Allocation {
    let linear = location != MemoryLocation::GpuOnly;
    let allocation_scheme = AllocationScheme::GpuAllocatorManaged;
    let description = AllocationCreateDesc { name: "host", requirements, location, linear, allocation_scheme };
    host.allocator.lock().unwrap().allocate(&description).unwrap()
}
