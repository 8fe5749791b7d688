//! Makes the transient buffers and images of the stages, sized by scene, picture and view.

use crate::abi::TILE;
use crate::frame::capacities::Capacities;
use crate::frame::counts::Counts;
use crate::gpu::{Buffer, BufferInfo, Device, GpuError, Image, ImageInfo, MemoryLocation, Pool, Texel, TexelBuffer};
use ash::vk;

/// The quantities from which sizes follow.
#[derive(Clone, Copy)]
pub(crate) struct Room<'a> {
    pub device: &'a Device,
    pub counts: Counts,
    pub capacities: Capacities,
    /// Size of the picture.
    pub size: (u32, u32),
}

/// Images that passes draw into and read as storage images.
pub(crate) const DRAWN_AND_READ: vk::ImageUsageFlags = vk::ImageUsageFlags::from_raw(
    vk::ImageUsageFlags::COLOR_ATTACHMENT.as_raw() | vk::ImageUsageFlags::STORAGE.as_raw(),
);

/// Images that are cleared, changed by atomics in shaders, and sampled or loaded.
pub(crate) const COUNTED: vk::ImageUsageFlags = vk::ImageUsageFlags::from_raw(
    vk::ImageUsageFlags::STORAGE.as_raw()
        | vk::ImageUsageFlags::SAMPLED.as_raw()
        | vk::ImageUsageFlags::TRANSFER_DST.as_raw(),
);

impl Room<'_> {
    /// A buffer of `n` words.
    pub(crate) fn words(&self, name: &str, n: u32) -> Result<Buffer, GpuError> {
        self.structs::<u32>(name, n)
    }

    /// A buffer of `n` structs.
    pub(crate) fn structs<T>(&self, name: &str, n: u32) -> Result<Buffer, GpuError> {
        Buffer::storage(self.device, Pool::Transient, name, u64::from(n) * size_of::<T>() as u64)
    }

    /// A buffer of `n` indirect commands.
    pub(crate) fn indirect<T>(&self, name: &str, n: u32) -> Result<Buffer, GpuError> {
        Buffer::indirect(self.device, Pool::Transient, name, u64::from(n) * size_of::<T>() as u64)
    }

    /// A buffer of `n` structs or words, written as such and read as texels.
    pub(crate) fn texels<T>(&self, name: &str, n: u32, texel: Texel) -> Result<TexelBuffer, GpuError> {
        let usage = Buffer::STORAGE | vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER;
        let bytes = u64::from(n) * size_of::<T>() as u64;
        let info = BufferInfo { name, bytes, usage, pool: Pool::Transient, location: MemoryLocation::Device };
        TexelBuffer::new(self.device, Buffer::new(self.device, &info)?, texel)
    }

    /// An image of the picture's size.
    pub(crate) fn image(&self, name: &str, format: vk::Format, usage: vk::ImageUsageFlags) -> Result<Image, GpuError> {
        Image::new(self.device, &ImageInfo { name, size: self.size, format, usage, pool: Pool::Transient })
    }

    /// Number of squares of `side` pixels that cover the picture.
    pub(crate) fn squares(&self, side: u32) -> u32 {
        self.size.0.div_ceil(side) * self.size.1.div_ceil(side)
    }

    /// Rows of tiles in a band of Boolean solids' lists.
    pub(crate) fn band_rows(&self) -> u32 {
        self.capacities.solids.band_rows.min(self.size.1.div_ceil(TILE))
    }

    /// Pixels of a band.
    pub(crate) fn band_pixels(&self) -> u32 {
        self.size.0 * (self.band_rows() * TILE).min(self.size.1)
    }
}
