//! A two-dimensional image with its view and memory, or the host's image borrowed; and samplers.

use super::device::Registration;
use super::memory::Memory;
use super::{Device, GpuError, MemoryLocation, Named, Pool};
use ash::vk;

/// The parameters of an image: one layer, one level, one sample a pixel.
#[derive(Clone, Copy, Debug)]
pub struct ImageInfo<'a> {
    /// Name in errors, validation messages and [`Device::objects`].
    pub name: &'a str,
    /// Width and height in pixels, at least 1.
    pub size: (u32, u32),
    /// Format; depth formats get a depth view.
    pub format: vk::Format,
    /// Its uses.
    pub usage: vk::ImageUsageFlags,
    /// Its lifetime.
    pub pool: Pool,
}

/// An image and its view; frees what it owns on drop. The GPU must have finished with it before.
#[derive(Debug)]
pub struct Image {
    handle: vk::Image,
    view: vk::ImageView,
    size: (u32, u32),
    format: vk::Format,
    aspect: vk::ImageAspectFlags,
    name: String,
    // `None` for the host's images.
    memory: Option<Memory>,
    registration: Option<Registration>,
}

/// Aspects of a format.
fn aspect_of(format: vk::Format) -> vk::ImageAspectFlags {
    match format {
        vk::Format::D16_UNORM | vk::Format::X8_D24_UNORM_PACK32 | vk::Format::D32_SFLOAT => vk::ImageAspectFlags::DEPTH,
        vk::Format::D16_UNORM_S8_UINT | vk::Format::D24_UNORM_S8_UINT | vk::Format::D32_SFLOAT_S8_UINT => {
            vk::ImageAspectFlags::DEPTH | vk::ImageAspectFlags::STENCIL
        }
        vk::Format::S8_UINT => vk::ImageAspectFlags::STENCIL,
        _ => vk::ImageAspectFlags::COLOR,
    }
}

impl Image {
    /// Makes an image of undefined contents in layout `UNDEFINED`.
    ///
    /// # Errors
    /// [`GpuError::Allocation`] without memory, [`GpuError::Vulkan`].
    pub fn new(device: &Device, info: &ImageInfo<'_>) -> Result<Self, GpuError> {
        let create = vk::ImageCreateInfo::default()
            .image_type(vk::ImageType::TYPE_2D)
            .format(info.format)
            .extent(vk::Extent3D { width: info.size.0, height: info.size.1, depth: 1 })
            .mip_levels(1)
            .array_layers(1)
            .samples(vk::SampleCountFlags::TYPE_1)
            .tiling(vk::ImageTiling::OPTIMAL)
            .usage(info.usage);
        // SAFETY: the device is alive while `Device` is.
        let handle = unsafe { device.raw().create_image(&create, None) }.named("vkCreateImage", info.name)?;
        let aspect = aspect_of(info.format);
        let parts = Self::bind(device, info, handle).and_then(|memory| {
            let view = vk::ImageViewCreateInfo::default()
                .image(handle)
                .view_type(vk::ImageViewType::TYPE_2D)
                .format(info.format)
                .subresource_range(whole(aspect));
            // SAFETY: the image is bound and belongs to this device.
            let view = unsafe { device.raw().create_image_view(&view, None) }.named("vkCreateImageView", info.name)?;
            Ok((memory, view))
        });
        let (memory, view) = parts.inspect_err(|_| {
            // SAFETY: nobody else has seen the handle.
            unsafe { device.raw().destroy_image(handle, None) }
        })?;
        device.set_name(handle, info.name);
        device.set_name(view, info.name);
        let (size, format, name) = (info.size, info.format, info.name.to_owned());
        let registration = Some(device.register(info.name, memory.bytes()));
        Ok(Self { handle, view, size, format, aspect, name, memory: Some(memory), registration })
    }

    fn bind(device: &Device, info: &ImageInfo<'_>, handle: vk::Image) -> Result<Memory, GpuError> {
        // SAFETY: the image was just made from this device.
        let requirements = unsafe { device.raw().get_image_memory_requirements(handle) };
        let memory = Memory::new(device, info.name, requirements, info.pool, MemoryLocation::Device, false)?;
        let (raw, offset) = memory.raw();
        // SAFETY: memory and image belong to this device, neither is bound yet.
        unsafe { device.raw().bind_image_memory(handle, raw, offset) }.named("vkBindImageMemory", info.name)?;
        Ok(memory)
    }

    /// Borrows the host's image, such as one of its swapchain; it is never destroyed here.
    ///
    /// # Safety
    /// `view` shows the only layer and level of `handle`, whose size and format are as given; both
    /// outlive this value and the GPU's work with it.
    pub unsafe fn borrowed(
        name: &str,
        handle: vk::Image,
        view: vk::ImageView,
        size: (u32, u32),
        format: vk::Format,
    ) -> Self {
        let (aspect, name) = (aspect_of(format), name.to_owned());
        Self { handle, view, size, format, aspect, name, memory: None, registration: None }
    }

    /// Bytes of its memory; 0 for the host's images.
    pub fn bytes(&self) -> u64 {
        self.memory.as_ref().map_or(0, Memory::bytes)
    }

    /// The Vulkan image.
    pub fn handle(&self) -> vk::Image {
        self.handle
    }

    /// Its only view.
    pub fn view(&self) -> vk::ImageView {
        self.view
    }

    /// Width and height in pixels.
    pub fn size(&self) -> (u32, u32) {
        self.size
    }

    /// Its format.
    pub fn format(&self) -> vk::Format {
        self.format
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its pool; `None` for the host's images.
    pub fn pool(&self) -> Option<Pool> {
        self.memory.as_ref().map(Memory::pool)
    }

    /// All of it, for barriers and clears.
    pub fn range(&self) -> vk::ImageSubresourceRange {
        whole(self.aspect)
    }
}

fn whole(aspect: vk::ImageAspectFlags) -> vk::ImageSubresourceRange {
    vk::ImageSubresourceRange::default().aspect_mask(aspect).level_count(1).layer_count(1)
}

impl Drop for Image {
    fn drop(&mut self) {
        let Some(device) = self.registration.as_ref().and_then(|owned| owned.device().living()) else { return };
        // SAFETY: owned here; the GPU has finished with them, as the type's contract says.
        unsafe {
            device.destroy_image_view(self.view, None);
            device.destroy_image(self.handle, None);
        }
    }
}

/// A sampler that clamps to the edge.
#[derive(Debug)]
pub struct Sampler {
    handle: vk::Sampler,
    device: Device,
}

impl Sampler {
    /// Makes a sampler with one filter for both directions.
    ///
    /// # Errors
    /// [`GpuError::Vulkan`].
    pub fn new(device: &Device, filter: vk::Filter) -> Result<Self, GpuError> {
        let edge = vk::SamplerAddressMode::CLAMP_TO_EDGE;
        let create = vk::SamplerCreateInfo::default()
            .mag_filter(filter)
            .min_filter(filter)
            .address_mode_u(edge)
            .address_mode_v(edge)
            .address_mode_w(edge);
        // SAFETY: the device is alive while `Device` is.
        let handle = unsafe { device.raw().create_sampler(&create, None) }.named("vkCreateSampler", "sampler")?;
        Ok(Self { handle, device: device.clone() })
    }

    /// The Vulkan sampler.
    pub fn handle(&self) -> vk::Sampler {
        self.handle
    }
}

impl Drop for Sampler {
    fn drop(&mut self) {
        let Some(device) = self.device.living() else { return };
        // SAFETY: owned here; the GPU has finished with it.
        unsafe { device.destroy_sampler(self.handle, None) }
    }
}
