//! The window's images, made again when the window changes.

use super::ViewError;
use super::context::Context;
use ash::vk;
use selvedge::ash;

/// Images to present, and a semaphore each that its drawing signals.
pub struct Swapchain {
    pub handle: vk::SwapchainKHR,
    pub size: (u32, u32),
    pub images: Vec<(vk::Image, vk::ImageView)>,
    pub drawn: Vec<vk::Semaphore>,
}

/// The result of acquiring or presenting an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Presented {
    /// It is shown.
    Shown,
    /// The window has changed: make a new swapchain.
    Outdated,
    /// The surface is gone: make a new one, and a swapchain.
    SurfaceLost,
}

impl Presented {
    /// From Vulkan's result; other failures are errors.
    pub fn of(answer: Result<bool, vk::Result>) -> Result<Self, ViewError> {
        match answer {
            Ok(false) => Ok(Self::Shown),
            Ok(true) | Err(vk::Result::ERROR_OUT_OF_DATE_KHR) => Ok(Self::Outdated),
            Err(vk::Result::ERROR_SURFACE_LOST_KHR) => Ok(Self::SurfaceLost),
            Err(error) => Err(error.into()),
        }
    }
}

/// Formats that encode by themselves, as the engine's own target does.
const FORMATS: [vk::Format; 2] = [vk::Format::B8G8R8A8_SRGB, vk::Format::R8G8B8A8_SRGB];

/// The surface's format.
pub fn format(context: &Context) -> Result<vk::SurfaceFormatKHR, ViewError> {
    // SAFETY: device and surface are alive.
    let all = unsafe { context.surfaces.get_physical_device_surface_formats(context.physical, context.surface) }?;
    let found = FORMATS.iter().find_map(|wanted| all.iter().find(|f| f.format == *wanted));
    found.copied().ok_or_else(|| ViewError::Window("the surface has no sRGB format of 8 bits".to_owned()))
}

impl Swapchain {
    /// Images of the window's size; `None` while it has none. The device is idle. `old` is used no more, and destroyed;
    /// if a step fails, nothing is left of either.
    pub fn new(context: &Context, size: (u32, u32), old: Option<Self>) -> Result<Option<Self>, ViewError> {
        let made = Self::in_place_of(context, size, old.as_ref());
        if let Some(old) = old {
            old.destroy(context);
        }
        let Some((handle, extent, format)) = made? else { return Ok(None) };
        let size = (extent.width, extent.height);
        let mut chain = Self { handle, size, images: Vec::new(), drawn: Vec::new() };
        match chain.fill(context, format) {
            Ok(()) => Ok(Some(chain)),
            Err(error) => {
                chain.destroy(context);
                Err(error.into())
            }
        }
    }

    /// The handle, the size and the format of a new one; `None` while the window has no size.
    fn in_place_of(
        context: &Context,
        size: (u32, u32),
        old: Option<&Self>,
    ) -> Result<Option<(vk::SwapchainKHR, vk::Extent2D, vk::Format)>, ViewError> {
        let (surfaces, physical, surface) = (&context.surfaces, context.physical, context.surface);
        // SAFETY: device and surface are alive; nothing uses the old swapchain.
        unsafe {
            let limits = surfaces.get_physical_device_surface_capabilities(physical, surface)?;
            let extent = match limits.current_extent {
                vk::Extent2D { width: u32::MAX, .. } => vk::Extent2D {
                    width: size.0.clamp(limits.min_image_extent.width, limits.max_image_extent.width),
                    height: size.1.clamp(limits.min_image_extent.height, limits.max_image_extent.height),
                },
                extent => extent,
            };
            if extent.width == 0 || extent.height == 0 {
                return Ok(None);
            }
            let format = format(context)?;
            let most = if limits.max_image_count == 0 { u32::MAX } else { limits.max_image_count };
            let create = vk::SwapchainCreateInfoKHR::default()
                .surface(surface)
                .min_image_count((limits.min_image_count + 1).min(most))
                .image_format(format.format)
                .image_color_space(format.color_space)
                .image_extent(extent)
                .image_array_layers(1)
                .image_usage(vk::ImageUsageFlags::COLOR_ATTACHMENT)
                .pre_transform(limits.current_transform)
                .composite_alpha(vk::CompositeAlphaFlagsKHR::OPAQUE)
                .present_mode(vk::PresentModeKHR::FIFO)
                .clipped(true)
                .old_swapchain(old.map_or(vk::SwapchainKHR::null(), |old| old.handle));
            let handle = context.swapchains.create_swapchain(&create, None)?;
            Ok(Some((handle, extent, format.format)))
        }
    }

    /// Adds views of its images, and semaphores.
    fn fill(&mut self, context: &Context, format: vk::Format) -> Result<(), vk::Result> {
        // SAFETY: device and swapchain are alive.
        unsafe {
            for image in context.swapchains.get_swapchain_images(self.handle)? {
                let range = vk::ImageSubresourceRange::default()
                    .aspect_mask(vk::ImageAspectFlags::COLOR)
                    .level_count(1)
                    .layer_count(1);
                let create = vk::ImageViewCreateInfo::default()
                    .image(image)
                    .view_type(vk::ImageViewType::TYPE_2D)
                    .format(format)
                    .subresource_range(range);
                self.images.push((image, context.device.create_image_view(&create, None)?));
                self.drawn.push(context.device.create_semaphore(&vk::SemaphoreCreateInfo::default(), None)?);
            }
        }
        Ok(())
    }

    /// Frees it. The device is idle.
    pub fn destroy(self, context: &Context) {
        // SAFETY: nothing uses it any more.
        unsafe {
            self.drawn.iter().for_each(|s| context.device.destroy_semaphore(*s, None));
            self.images.iter().for_each(|(_, view)| context.device.destroy_image_view(*view, None));
            context.swapchains.destroy_swapchain(self.handle, None);
        }
    }
}
