//! Copies device memory to memory that the CPU reads after the fence.

use super::{Access, Buffer, BufferInfo, Commands, Device, GpuError, Image, MemoryLocation, Pool, barrier};
use ash::vk;
use bytemuck::Pod;

/// A mapped buffer for the CPU to read; it is recorded into again in each frame.
#[derive(Debug)]
pub struct ReadBack {
    buffer: Buffer,
}

impl ReadBack {
    /// Room for `bytes`.
    ///
    /// # Errors
    /// See [`Buffer::new`].
    pub fn new(device: &Device, name: &str, bytes: u64) -> Result<Self, GpuError> {
        let usage = vk::BufferUsageFlags::TRANSFER_DST;
        let info = BufferInfo { name, bytes, usage, pool: Pool::Ring, location: MemoryLocation::ReadBack };
        Ok(Self { buffer: Buffer::new(device, &info)? })
    }

    /// Records the copy of the first `bytes` of `from`, which is in [`Access::TRANSFER_READ`].
    ///
    /// # Panics
    /// If they do not fit.
    pub fn record(&self, cmd: &Commands<'_>, from: &Buffer, bytes: u64) {
        self.record_nth(cmd, from, bytes, 0);
    }

    /// The same, after `nth` copies of the same size.
    ///
    /// # Panics
    /// If they do not fit.
    pub fn record_nth(&self, cmd: &Commands<'_>, from: &Buffer, bytes: u64, nth: u64) {
        cmd.copy(from, 0, &self.buffer, nth * bytes, bytes);
        barrier::buffers(cmd, &[(&self.buffer, Access::TRANSFER_WRITE, Access::HOST_READ)]);
    }

    /// Records the copy of one aspect of an image, rows packed from the top; the image is in
    /// [`Access::TRANSFER_READ`].
    pub fn record_image(&self, cmd: &Commands<'_>, from: &Image, aspect: vk::ImageAspectFlags) {
        cmd.copy_image(from, aspect, &self.buffer);
        barrier::buffers(cmd, &[(&self.buffer, Access::TRANSFER_WRITE, Access::HOST_READ)]);
    }

    /// Records the copies of one pixel of each image, of `bytes` bytes, one after another. The images are in layout
    /// `GENERAL`; a barrier from [`Access::TRANSFER_READ`] must precede their next use.
    ///
    /// # Panics
    /// If they do not fit.
    pub fn record_pixels(&self, cmd: &Commands<'_>, from: &[&Image], at: (u32, u32), bytes: u64) {
        for (nth, image) in (0..).zip(from) {
            cmd.copy_pixel(image, at, &self.buffer, (nth * bytes, bytes));
        }
        barrier::buffers(cmd, &[(&self.buffer, Access::TRANSFER_WRITE, Access::HOST_READ)]);
    }

    /// The first `count` values in place, after the fence.
    ///
    /// # Panics
    /// If the buffer is shorter.
    pub fn slice<T: Pod>(&self, count: usize) -> &[T] {
        let Some(mapped) = self.buffer.mapped() else { panic!("`{}` is not mapped", self.buffer.name()) };
        bytemuck::cast_slice(&mapped[..count * size_of::<T>()])
    }

    /// A copy of the first `count` values, after the fence.
    ///
    /// # Panics
    /// If the buffer is shorter.
    pub fn values<T: Pod>(&self, count: usize) -> Vec<T> {
        self.slice(count).to_vec()
    }
}
