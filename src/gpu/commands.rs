//! Records into the host's command buffer.

use super::{Access, Attachment, Buffer, Device, Image, ImageAccess, Pipeline, Resource, barrier, push};
use ash::vk;
use std::ffi::CString;
use std::ops::Range;

/// A command buffer in the recording state, and its device.
///
/// The methods are Vulkan's commands with the engine's types. Cheap checks are made; the caller is responsible for
/// Vulkan's other rules, which validation layers check.
#[derive(Clone, Copy)]
pub struct Commands<'a> {
    device: &'a Device,
    raw: vk::CommandBuffer,
}

impl<'a> Commands<'a> {
    /// Records into `raw`.
    ///
    /// # Safety
    /// `raw` belongs to `device` and its queue family, is in the recording state outside a render
    /// pass, and is used by one thread. What is recorded outlives the GPU's work.
    pub unsafe fn new(device: &'a Device, raw: vk::CommandBuffer) -> Self {
        Self { device, raw }
    }

    /// The device.
    pub fn device(&self) -> &'a Device {
        self.device
    }

    /// The Vulkan command buffer.
    pub fn raw(&self) -> vk::CommandBuffer {
        self.raw
    }

    /// Orders earlier accesses to buffers before later ones. Images have
    /// [`barrier::images`], which change their layouts, too.
    pub fn after(&self, before: Access, next: Access) {
        barrier::memory(self, before, next);
    }

    /// Binds a pipeline with its resources in binding order and its push constants.
    ///
    /// # Panics
    /// When resources or push constants are not those that the pipeline was made for.
    pub fn bind(&self, pipeline: &Pipeline, resources: &[Resource<'_>], push_constants: &[u8]) {
        let device = self.device.raw();
        // SAFETY: recording; the pipeline belongs to this device.
        unsafe { device.cmd_bind_pipeline(self.raw, pipeline.point(), pipeline.handle()) };
        push::resources(self, pipeline, resources);
        self.push_constants(pipeline, push_constants);
    }

    /// Replaces the push constants of the pipeline bound last.
    ///
    /// # Panics
    /// If their size is not the pipeline's.
    pub fn push_constants(&self, pipeline: &Pipeline, bytes: &[u8]) {
        assert_eq!(bytes.len(), pipeline.push_bytes() as usize, "push constants of `{}`", pipeline.name());
        if !bytes.is_empty() {
            // SAFETY: recording; the range is the layout's.
            unsafe {
                self.device.raw().cmd_push_constants(self.raw, pipeline.layout(), pipeline.stages(), 0, bytes);
            }
        }
    }

    /// Starts at least `groups` workgroups. They are one row in x; if the device takes fewer in x, they are several
    /// full rows. The shader numbers workgroups by `glsl/include/thread.glsl` and skips those beyond the last.
    ///
    /// # Panics
    /// When the device does not take so many in x and y.
    pub fn dispatch(&self, groups: u32) {
        let [most, most_rows, _] = self.device.limits().max_compute_work_group_count;
        let columns = groups.min(most);
        let rows = groups.div_ceil(columns.max(1)).max(1);
        assert!(rows <= most_rows, "{groups} workgroups where {most_rows} rows of {most} are the most");
        self.dispatch_grid([columns, rows, 1]);
    }

    /// Starts a grid of workgroups.
    pub fn dispatch_grid(&self, [x, y, z]: [u32; 3]) {
        // SAFETY: recording; a compute pipeline is bound.
        unsafe { self.device.raw().cmd_dispatch(self.raw, x, y, z) };
    }

    /// Starts the grid stored at `offset` bytes of `arguments` (`VkDispatchIndirectCommand`).
    pub fn dispatch_indirect(&self, arguments: &Buffer, offset: u64) {
        // SAFETY: recording; a compute pipeline is bound.
        unsafe { self.device.raw().cmd_dispatch_indirect(self.raw, arguments.handle(), offset) };
    }

    /// Draws `vertices` from `first_vertex`, `instances` times.
    pub fn draw(&self, vertices: u32, first_vertex: u32, instances: u32) {
        // SAFETY: recording within `rendering`; a graphics pipeline is bound.
        unsafe { self.device.raw().cmd_draw(self.raw, vertices, instances, first_vertex, 0) };
    }

    /// Draws a range of vertices once for each of a range of instances.
    pub fn draw_instances(&self, vertices: Range<u32>, instances: Range<u32>) {
        let (count, copies) = (vertices.len() as u32, instances.len() as u32);
        // SAFETY: recording within `rendering`; a graphics pipeline is bound.
        unsafe { self.device.raw().cmd_draw(self.raw, count, copies, vertices.start, instances.start) };
    }

    /// Draws with arguments and a count from the GPU: `offset` bytes into `arguments`, `count_offset` bytes into
    /// `count`; at most `most` draws.
    pub fn draw_indirect_count(&self, arguments: &Buffer, offset: u64, count: &Buffer, count_offset: u64, most: u32) {
        let (arguments, count) = (arguments.handle(), count.handle());
        let stride = size_of::<vk::DrawIndirectCommand>() as u32;
        // SAFETY: recording within `rendering`; a graphics pipeline is bound.
        unsafe {
            self.device.raw().cmd_draw_indirect_count(self.raw, arguments, offset, count, count_offset, most, stride);
        }
    }

    /// Draws into attachments of `size` pixels: `record` makes the draws. Viewport and scissor cover
    /// the attachments; depth runs over `[0, 1]`.
    pub fn rendering<R>(
        &self,
        size: (u32, u32),
        colour: &[Attachment<'_>],
        depth: Option<Attachment<'_>>,
        record: impl FnOnce() -> R,
    ) -> R {
        self.rendering_to((size, 0..size.1), colour, (depth, None), record)
    }

    /// As [`rendering`](Self::rendering), restricted to these rows of pixels; other rows of the attachments stay.
    pub fn rendering_rows<R>(
        &self,
        size: ((u32, u32), Range<u32>),
        colour: &[Attachment<'_>],
        depth: Option<Attachment<'_>>,
        record: impl FnOnce() -> R,
    ) -> R {
        self.rendering_to(size, colour, (depth, None), record)
    }

    /// As [`rendering`](Self::rendering), with a stencil attachment instead of a depth attachment.
    pub fn rendering_stencil<R>(
        &self,
        size: (u32, u32),
        colour: &[Attachment<'_>],
        stencil: Attachment<'_>,
        record: impl FnOnce() -> R,
    ) -> R {
        self.rendering_to((size, 0..size.1), colour, (None, Some(stencil)), record)
    }

    fn rendering_to<R>(
        &self,
        (size, rows): ((u32, u32), Range<u32>),
        colour: &[Attachment<'_>],
        (depth, stencil): (Option<Attachment<'_>>, Option<Attachment<'_>>),
        record: impl FnOnce() -> R,
    ) -> R {
        let area = vk::Rect2D {
            offset: vk::Offset2D { x: 0, y: rows.start as i32 },
            extent: vk::Extent2D { width: size.0, height: rows.len() as u32 },
        };
        let colour: Vec<_> = colour.iter().map(|attachment| attachment.info(Access::COLOUR_WRITE)).collect();
        let depth = depth.map(|attachment| attachment.info(Access::DEPTH_WRITE));
        let stencil = stencil.map(|attachment| attachment.info(Access::DEPTH_WRITE));
        let mut info = vk::RenderingInfo::default().render_area(area).layer_count(1).color_attachments(&colour);
        if let Some(depth) = &depth {
            info = info.depth_attachment(depth);
        }
        if let Some(stencil) = &stencil {
            info = info.stencil_attachment(stencil);
        }
        let viewport =
            vk::Viewport { width: size.0 as f32, height: size.1 as f32, max_depth: 1.0, ..Default::default() };
        let device = self.device.raw();
        // SAFETY: recording outside rendering; the views belong to this device.
        unsafe {
            device.cmd_begin_rendering(self.raw, &info);
            device.cmd_set_viewport(self.raw, 0, &[viewport]);
            device.cmd_set_scissor(self.raw, 0, &[area]);
        }
        let result = record();
        // SAFETY: begun above.
        unsafe { device.cmd_end_rendering(self.raw) };
        result
    }

    /// Sets the reference of the stencil test, the mask of compared bits and the mask of written bits.
    pub fn stencil(&self, reference: u32, compare: u32, write: u32) {
        let (device, both) = (self.device.raw(), vk::StencilFaceFlags::FRONT_AND_BACK);
        // SAFETY: recording.
        unsafe {
            device.cmd_set_stencil_reference(self.raw, both, reference);
            device.cmd_set_stencil_compare_mask(self.raw, both, compare);
            device.cmd_set_stencil_write_mask(self.raw, both, write);
        }
    }

    /// Fills a whole buffer with a word: [`Access::TRANSFER_WRITE`].
    pub fn fill(&self, buffer: &Buffer, word: u32) {
        // SAFETY: recording outside rendering; the buffer belongs to this device.
        unsafe { self.device.raw().cmd_fill_buffer(self.raw, buffer.handle(), 0, vk::WHOLE_SIZE, word) };
    }

    /// Clears an image of unsigned integers: [`Access::TRANSFER_WRITE`].
    pub fn clear(&self, image: &Image, word: u32) {
        let colour = vk::ClearColorValue { uint32: [word; 4] };
        let range =
            vk::ImageSubresourceRange::default().aspect_mask(vk::ImageAspectFlags::COLOR).level_count(1).layer_count(1);
        let layout = ImageAccess::from(Access::TRANSFER_WRITE).layout;
        // SAFETY: recording outside rendering; the image belongs to this device.
        unsafe { self.device.raw().cmd_clear_color_image(self.raw, image.handle(), layout, &colour, &[range]) };
    }

    /// Fills the first words of a buffer, as a transfer write.
    pub fn fill_first(&self, buffer: &Buffer, words: u64, word: u32) {
        let bytes = words * size_of::<u32>() as u64;
        // SAFETY: recording outside rendering; the buffer belongs to this device.
        unsafe { self.device.raw().cmd_fill_buffer(self.raw, buffer.handle(), 0, bytes, word) };
    }

    /// Fills one word, the `nth`, as a transfer write.
    pub fn fill_word(&self, buffer: &Buffer, nth: u64, word: u32) {
        let bytes = size_of::<u32>() as u64;
        // SAFETY: recording outside rendering; the buffer belongs to this device.
        unsafe { self.device.raw().cmd_fill_buffer(self.raw, buffer.handle(), nth * bytes, bytes, word) };
    }

    /// Copies bytes between buffers: [`Access::TRANSFER_READ`] to [`Access::TRANSFER_WRITE`].
    ///
    /// # Panics
    /// When the bytes do not fit in both.
    pub fn copy(&self, from: &Buffer, from_offset: u64, to: &Buffer, to_offset: u64, bytes: u64) {
        assert!(to_offset + bytes <= to.bytes(), "copy of {bytes} bytes from `{}` to `{}`", from.name(), to.name());
        self.copy_to(from, from_offset, to.handle(), to_offset, bytes);
    }

    /// As [`copy`](Self::copy), to a buffer that has room for the bytes.
    pub(super) fn copy_to(&self, from: &Buffer, from_offset: u64, to: vk::Buffer, to_offset: u64, bytes: u64) {
        assert!(from_offset + bytes <= from.bytes(), "copy of {bytes} bytes from `{}`", from.name());
        if bytes == 0 {
            return;
        }
        let region = vk::BufferCopy { src_offset: from_offset, dst_offset: to_offset, size: bytes };
        // SAFETY: recording outside rendering; the regions lie within the buffers.
        unsafe { self.device.raw().cmd_copy_buffer(self.raw, from.handle(), to, &[region]) };
    }

    /// Copies one pixel, of `bytes` bytes, of a colour image in layout `GENERAL` to `offset` bytes of a buffer.
    ///
    /// # Panics
    /// When the pixel is not in the image, or its bytes do not fit.
    pub fn copy_pixel(&self, from: &Image, (x, y): (u32, u32), to: &Buffer, (offset, bytes): (u64, u64)) {
        let (width, height) = from.size();
        assert!(x < width && y < height && offset + bytes <= to.bytes(), "pixel {x}, {y} of `{}`", from.name());
        let layers = vk::ImageSubresourceLayers::default().aspect_mask(vk::ImageAspectFlags::COLOR).layer_count(1);
        let region = vk::BufferImageCopy::default()
            .buffer_offset(offset)
            .image_subresource(layers)
            .image_offset(vk::Offset3D { x: x as i32, y: y as i32, z: 0 })
            .image_extent(vk::Extent3D { width: 1, height: 1, depth: 1 });
        let layout = vk::ImageLayout::GENERAL;
        // SAFETY: recording outside rendering; both belong to this device.
        unsafe {
            self.device.raw().cmd_copy_image_to_buffer(self.raw, from.handle(), layout, to.handle(), &[region]);
        }
    }

    /// Copies one aspect of an image, rows packed: [`Access::TRANSFER_READ`] to
    /// [`Access::TRANSFER_WRITE`].
    pub fn copy_image(&self, from: &Image, aspect: vk::ImageAspectFlags, to: &Buffer) {
        let (width, height) = from.size();
        let layers = vk::ImageSubresourceLayers::default().aspect_mask(aspect).layer_count(1);
        let region = vk::BufferImageCopy::default().image_subresource(layers).image_extent(vk::Extent3D {
            width,
            height,
            depth: 1,
        });
        let layout = ImageAccess::from(Access::TRANSFER_READ).layout;
        // SAFETY: recording outside rendering; both belong to this device.
        unsafe {
            self.device.raw().cmd_copy_image_to_buffer(self.raw, from.handle(), layout, to.handle(), &[region]);
        }
    }

    /// Copies a rectangle of `size` pixels, in every aspect, between images of one format. Each image comes with the
    /// upper left pixel of its rectangle. [`Access::TRANSFER_READ`] to [`Access::TRANSFER_WRITE`].
    pub fn copy_rectangle(
        &self,
        (from, from_at): (&Image, (u32, u32)),
        (to, to_at): (&Image, (u32, u32)),
        size: (u32, u32),
    ) {
        let layers =
            |image: &Image| vk::ImageSubresourceLayers::default().aspect_mask(image.range().aspect_mask).layer_count(1);
        let offset = |(x, y): (u32, u32)| vk::Offset3D { x: x as i32, y: y as i32, z: 0 };
        let region = vk::ImageCopy::default()
            .src_subresource(layers(from))
            .src_offset(offset(from_at))
            .dst_subresource(layers(to))
            .dst_offset(offset(to_at))
            .extent(vk::Extent3D { width: size.0, height: size.1, depth: 1 });
        let [read, write] = [Access::TRANSFER_READ, Access::TRANSFER_WRITE].map(|a| ImageAccess::from(a).layout);
        let regions = [region];
        // SAFETY: recording outside rendering; both belong to this device.
        unsafe { self.device.raw().cmd_copy_image(self.raw, from.handle(), read, to.handle(), write, &regions) };
    }

    /// Labels the commands of `record` in captures and validation messages.
    pub fn labelled<R>(&self, name: &str, record: impl FnOnce() -> R) -> R {
        let debug = self.device.debug_utils().zip(CString::new(name).ok());
        if let Some((debug, name)) = &debug {
            // SAFETY: recording.
            unsafe {
                debug.cmd_begin_debug_utils_label(self.raw, &vk::DebugUtilsLabelEXT::default().label_name(name));
            }
        }
        let result = record();
        if let Some((debug, _)) = &debug {
            // SAFETY: begun above.
            unsafe { debug.cmd_end_debug_utils_label(self.raw) };
        }
        result
    }

    pub(crate) fn pipeline_barrier(&self, dependency: &vk::DependencyInfo<'_>) {
        // SAFETY: recording; the caller names resources of this device.
        unsafe { self.device.raw().cmd_pipeline_barrier2(self.raw, dependency) };
    }
}
