//! A buffer that shaders read through a format: `samplerBuffer`.
//!
//! One fetch returns a whole texel. llvmpipe loads a storage buffer word by word and lane by lane;
//! reading control points as texels makes its pixel shading several times faster, and costs real
//! GPUs nothing.

use super::{Buffer, Device, GpuError, Named};
use ash::vk;

/// A buffer of usage `UNIFORM_TEXEL_BUFFER` with a view of all of it; frees the view on drop.
#[derive(Debug)]
pub struct Texels {
    view: vk::BufferView,
    // Declared after the view that shows it.
    buffer: Buffer,
    device: Device,
}

impl Texels {
    /// Views `buffer` as four floats a texel.
    ///
    /// # Errors
    /// See [`Texels::new`].
    pub fn floats(device: &Device, buffer: Buffer) -> Result<Self, GpuError> {
        Self::new(device, buffer, vk::Format::R32G32B32A32_SFLOAT, size_of::<[f32; 4]>() as u64)
    }

    /// Views `buffer` as texels of `format`.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] when the buffer has more texels than the device can address,
    /// [`GpuError::Vulkan`].
    pub fn new(device: &Device, buffer: Buffer, format: vk::Format, texel_bytes: u64) -> Result<Self, GpuError> {
        let limit = u64::from(device.limits().max_texel_buffer_elements) * texel_bytes;
        if buffer.bytes() > limit {
            return Err(GpuError::TooLarge { resource: buffer.name().to_owned(), bytes: buffer.bytes(), limit });
        }
        let create = vk::BufferViewCreateInfo::default().buffer(buffer.handle()).format(format).range(vk::WHOLE_SIZE);
        // SAFETY: the buffer belongs to this device.
        let view =
            unsafe { device.raw().create_buffer_view(&create, None) }.named("vkCreateBufferView", buffer.name())?;
        Ok(Self { view, buffer, device: device.clone() })
    }

    /// The buffer.
    pub fn buffer(&self) -> &Buffer {
        &self.buffer
    }

    /// See [`Buffer::write`].
    pub(crate) fn write<T: bytemuck::Pod>(&mut self, offset: u64, data: &[T]) {
        self.buffer.write(offset, data);
    }

    pub(crate) fn view(&self) -> &vk::BufferView {
        &self.view
    }
}

impl Drop for Texels {
    fn drop(&mut self) {
        // SAFETY: owned here; the GPU has finished with it, as the buffer's contract says.
        unsafe { self.device.raw().destroy_buffer_view(self.view, None) }
    }
}
