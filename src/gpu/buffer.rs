//! A buffer with its memory.

use super::device::Registration;
use super::memory::Memory;
use super::{Device, GpuError, MemoryLocation, Named, Pool};
use ash::vk;
use bytemuck::Pod;

/// The parameters of a buffer.
#[derive(Clone, Copy, Debug)]
pub struct BufferInfo<'a> {
    /// Name in errors, validation messages and [`Device::objects`].
    pub name: &'a str,
    /// Size; rounded up to a multiple of [`Buffer::LEAST_BYTES`].
    pub bytes: u64,
    /// Its uses.
    pub usage: vk::BufferUsageFlags,
    /// Its lifetime.
    pub pool: Pool,
    /// Where its memory is.
    pub location: MemoryLocation,
}

/// A buffer; frees itself and its memory on drop. The GPU must have finished with it before.
#[derive(Debug)]
pub struct Buffer {
    handle: vk::Buffer,
    bytes: u64,
    usage: vk::BufferUsageFlags,
    name: String,
    // declared in the order of destruction
    memory: Memory,
    registration: Registration,
}

impl Buffer {
    /// Every size is a multiple of this: Vulkan has no empty buffers, and the last texel of four words must be
    /// complete.
    pub const LEAST_BYTES: u64 = 16;

    /// Usage of a buffer that passes fill, read, copy and take arguments from.
    pub const STORAGE: vk::BufferUsageFlags = vk::BufferUsageFlags::from_raw(
        vk::BufferUsageFlags::STORAGE_BUFFER.as_raw()
            | vk::BufferUsageFlags::TRANSFER_SRC.as_raw()
            | vk::BufferUsageFlags::TRANSFER_DST.as_raw(),
    );

    /// Usage of a [`STORAGE`](Self::STORAGE) buffer that also holds indirect arguments.
    pub const INDIRECT: vk::BufferUsageFlags =
        vk::BufferUsageFlags::from_raw(Self::STORAGE.as_raw() | vk::BufferUsageFlags::INDIRECT_BUFFER.as_raw());

    /// Makes a buffer of undefined contents.
    ///
    /// # Errors
    /// [`GpuError::TooLarge`] for a storage buffer above the device's range, [`GpuError::Allocation`]
    /// without memory, [`GpuError::Vulkan`].
    pub fn new(device: &Device, info: &BufferInfo<'_>) -> Result<Self, GpuError> {
        let bytes = info.bytes.max(1).next_multiple_of(Self::LEAST_BYTES);
        let limit = u64::from(device.limits().max_storage_buffer_range);
        if info.usage.contains(vk::BufferUsageFlags::STORAGE_BUFFER) && bytes > limit {
            return Err(GpuError::TooLarge { resource: info.name.to_owned(), bytes, limit });
        }
        let texels = info.usage.contains(vk::BufferUsageFlags::UNIFORM_TEXEL_BUFFER);
        let size = if texels { device.quirks().texel_buffer_bytes(bytes) } else { bytes };
        let create = vk::BufferCreateInfo::default().size(size).usage(info.usage);
        // SAFETY: the device is alive while `Device` is.
        let handle = unsafe { device.raw().create_buffer(&create, None) }.named("vkCreateBuffer", info.name)?;
        // SAFETY: the buffer was just made from this device.
        let requirements = unsafe { device.raw().get_buffer_memory_requirements(handle) };
        let bound = Memory::new(device, info.name, requirements, info.pool, info.location, true).and_then(|memory| {
            let (raw, offset) = memory.raw();
            // SAFETY: memory and buffer belong to this device, neither is bound yet.
            unsafe { device.raw().bind_buffer_memory(handle, raw, offset) }.named("vkBindBufferMemory", info.name)?;
            Ok(memory)
        });
        let memory = bound.inspect_err(|_| {
            // SAFETY: nobody else has seen the handle.
            unsafe { device.raw().destroy_buffer(handle, None) }
        })?;
        device.set_name(handle, info.name);
        let registration = device.register(info.name, memory.bytes());
        Ok(Self { handle, bytes, usage: info.usage, name: info.name.to_owned(), memory, registration })
    }

    /// A [`STORAGE`](Self::STORAGE) buffer in device memory.
    ///
    /// # Errors
    /// See [`Buffer::new`].
    pub fn storage(device: &Device, pool: Pool, name: &str, bytes: u64) -> Result<Self, GpuError> {
        Self::new(device, &BufferInfo { name, bytes, usage: Self::STORAGE, pool, location: MemoryLocation::Device })
    }

    /// An [`INDIRECT`](Self::INDIRECT) buffer in device memory.
    ///
    /// # Errors
    /// See [`Buffer::new`].
    pub fn indirect(device: &Device, pool: Pool, name: &str, bytes: u64) -> Result<Self, GpuError> {
        Self::new(device, &BufferInfo { name, bytes, usage: Self::INDIRECT, pool, location: MemoryLocation::Device })
    }

    /// A buffer in device memory of the same name, usage and pool, of another size and with undefined contents.
    ///
    /// # Errors
    /// See [`Buffer::new`].
    pub(crate) fn of_size(&self, bytes: u64) -> Result<Self, GpuError> {
        let (name, usage, pool) = (self.name.as_str(), self.usage, self.pool());
        let info = BufferInfo { name, bytes, usage, pool, location: MemoryLocation::Device };
        Self::new(self.registration.device(), &info)
    }

    /// The Vulkan buffer.
    pub fn handle(&self) -> vk::Buffer {
        self.handle
    }

    /// Size in bytes, a multiple of [`LEAST_BYTES`](Self::LEAST_BYTES).
    pub fn bytes(&self) -> u64 {
        self.bytes
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its pool.
    pub fn pool(&self) -> Pool {
        self.memory.pool()
    }

    /// The mapped contents; `None` if the memory is not visible to the CPU. Data written by the GPU is visible after a
    /// barrier to [`Access::HOST_READ`](super::Access::HOST_READ) and the frame's fence.
    pub fn mapped(&self) -> Option<&[u8]> {
        self.memory.mapped().map(|slice| &slice[..self.bytes as usize])
    }

    /// Writes `data` at `offset` bytes. The GPU must not be using the buffer.
    ///
    /// # Panics
    /// If the buffer is not mapped, or `data` does not fit.
    pub fn write<T: Pod>(&mut self, offset: u64, data: &[T]) {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let (start, end) = (offset as usize, offset as usize + bytes.len());
        assert!(end as u64 <= self.bytes, "{} bytes at {offset} do not fit in `{}`", bytes.len(), self.name);
        let Some(mapped) = self.memory.mapped_mut() else { panic!("`{}` is not mapped", self.name) };
        mapped[start..end].copy_from_slice(bytes);
    }
}

impl Drop for Buffer {
    fn drop(&mut self) {
        let Some(device) = self.registration.device().living() else { return };
        // SAFETY: owned here; the GPU has finished with it, as the type's contract says.
        unsafe { device.destroy_buffer(self.handle, None) }
    }
}
