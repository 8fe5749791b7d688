//! A buffer that shaders read through a format: `samplerBuffer`.
//!
//! One fetch returns a whole texel. llvmpipe loads a storage buffer word by word and lane by lane; reading control
//! points as texels makes its pixel shading several times faster, and costs hardware GPUs nothing.

use super::{Buffer, Device, GpuError, Named};
use ash::vk;
use std::ops::Deref;

/// The value of a fetch.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Texel {
    /// `usamplerBuffer`, words, four in a texel: `word_at` of `glsl/include/words.glsl`.
    Words,
    /// `usamplerBuffer`, x and y.
    U32x2,
    /// `usamplerBuffer`.
    U32x4,
    /// `samplerBuffer`, floats, four in a texel: `number_at`, `numbers_at`.
    Numbers,
    /// `samplerBuffer`.
    F32x4,
}

impl Texel {
    fn format(self) -> vk::Format {
        match self {
            Self::U32x2 => vk::Format::R32G32_UINT,
            Self::Words | Self::U32x4 => vk::Format::R32G32B32A32_UINT,
            Self::Numbers | Self::F32x4 => vk::Format::R32G32B32A32_SFLOAT,
        }
    }

    pub(super) fn bytes(self) -> u64 {
        match self {
            Self::U32x2 => 8,
            Self::Words | Self::Numbers | Self::U32x4 | Self::F32x4 => 16,
        }
    }

    /// Most bytes of a buffer that shaders read as such texels and write as a storage buffer.
    pub(crate) fn range(self, limits: &vk::PhysicalDeviceLimits) -> u32 {
        let texels = u64::from(limits.max_texel_buffer_elements) * self.bytes();
        limits.max_storage_buffer_range.min(u32::try_from(texels).unwrap_or(u32::MAX))
    }
}

/// A buffer of usage `UNIFORM_TEXEL_BUFFER` with a view of all of it; frees the view on drop. Passes that write it, or
/// read it as structs, bind its buffer.
#[derive(Debug)]
pub struct TexelBuffer {
    view: vk::BufferView,
    texel: Texel,
    // declared after the view of it
    buffer: Buffer,
    device: Device,
}

impl TexelBuffer {
    /// Views `buffer`.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] if the buffer has more texels than the device can address, [`GpuError::Vulkan`].
    pub fn new(device: &Device, buffer: Buffer, texel: Texel) -> Result<Self, GpuError> {
        let (format, bytes) = (texel.format(), texel.bytes());
        let limit = u64::from(device.limits().max_texel_buffer_elements) * bytes;
        if buffer.bytes() > limit {
            return Err(GpuError::TooLarge { resource: buffer.name().to_owned(), bytes: buffer.bytes(), limit });
        }
        let create = vk::BufferViewCreateInfo::default().buffer(buffer.handle()).format(format).range(vk::WHOLE_SIZE);
        // SAFETY: the buffer belongs to this device.
        let view =
            unsafe { device.raw().create_buffer_view(&create, None) }.named("vkCreateBufferView", buffer.name())?;
        Ok(Self { view, texel, buffer, device: device.clone() })
    }

    /// See [`Buffer::of_size`].
    pub(crate) fn of_size(&self, bytes: u64) -> Result<Self, GpuError> {
        Self::new(&self.device, self.buffer.of_size(bytes)?, self.texel)
    }

    /// See [`Buffer::write`].
    pub(crate) fn write<T: bytemuck::Pod>(&mut self, offset: u64, data: &[T]) {
        self.buffer.write(offset, data);
    }

    pub(crate) fn view(&self) -> &vk::BufferView {
        &self.view
    }
}

impl Deref for TexelBuffer {
    type Target = Buffer;

    fn deref(&self) -> &Buffer {
        &self.buffer
    }
}

impl Drop for TexelBuffer {
    fn drop(&mut self) {
        let Some(device) = self.device.living() else { return };
        // SAFETY: owned here; the GPU has finished with it, as the buffer's contract says.
        unsafe { device.destroy_buffer_view(self.view, None) }
    }
}
