//! Copies host data into device-local buffers, by staging buffers and a given command buffer.

use super::{Access, Buffer, BufferInfo, Commands, GpuError, MemoryLocation, Pool, barrier};
use ash::vk;
use bytemuck::Pod;

/// The staging buffers of copies that the GPU has not finished. Drop it after the fence.
#[derive(Debug, Default)]
pub struct Uploads {
    staging: Vec<Buffer>,
}

impl Uploads {
    /// No uploads yet.
    pub fn new() -> Self {
        Self::default()
    }

    /// Makes a buffer and records the copy of `data` into it. Follow with
    /// [`finish`](Self::finish) before it is used.
    ///
    /// # Errors
    /// See [`Buffer::new`].
    pub fn buffer<T: Pod>(
        &mut self,
        cmd: &Commands<'_>,
        pool: Pool,
        name: &str,
        usage: vk::BufferUsageFlags,
        data: &[T],
    ) -> Result<Buffer, GpuError> {
        // read when a larger one takes its place
        let copied = vk::BufferUsageFlags::TRANSFER_DST | vk::BufferUsageFlags::TRANSFER_SRC;
        let (bytes, usage) = (size_of_val(data) as u64, usage | copied);
        let buffer =
            Buffer::new(cmd.device(), &BufferInfo { name, bytes, usage, pool, location: MemoryLocation::Device })?;
        self.write(cmd, &buffer, 0, data)?;
        Ok(buffer)
    }

    /// Records the copy of `data` to `offset` bytes of `target`: [`Access::TRANSFER_WRITE`].
    ///
    /// # Errors
    /// See [`Buffer::new`], for the staging buffer.
    ///
    /// # Panics
    /// When `data` does not fit.
    pub fn write<T: Pod>(
        &mut self,
        cmd: &Commands<'_>,
        target: &Buffer,
        offset: u64,
        data: &[T],
    ) -> Result<(), GpuError> {
        if data.is_empty() {
            return Ok(());
        }
        let name = format!("staging of {}", target.name());
        let (bytes, usage) = (size_of_val(data) as u64, vk::BufferUsageFlags::TRANSFER_SRC);
        let info = BufferInfo { name: &name, bytes, usage, pool: Pool::Transient, location: MemoryLocation::Upload };
        let mut staging = Buffer::new(cmd.device(), &info)?;
        staging.write(0, data);
        cmd.copy(&staging, 0, target, offset, bytes);
        self.staging.push(staging);
        Ok(())
    }

    /// Records copies of bytes to offsets of several buffers, from one staging buffer: [`Access::TRANSFER_WRITE`].
    ///
    /// # Errors
    /// See [`Buffer::new`], for the staging buffer.
    ///
    /// # Panics
    /// When some bytes do not fit.
    pub fn scatter(
        &mut self,
        cmd: &Commands<'_>,
        name: &str,
        copies: &[(&Buffer, u64, &[u8])],
    ) -> Result<(), GpuError> {
        let bytes = copies.iter().map(|(_, _, data)| data.len() as u64).sum();
        if bytes == 0 {
            return Ok(());
        }
        let (name, usage) = (format!("staging of {name}"), vk::BufferUsageFlags::TRANSFER_SRC);
        let info = BufferInfo { name: &name, bytes, usage, pool: Pool::Transient, location: MemoryLocation::Upload };
        let mut staging = Buffer::new(cmd.device(), &info)?;
        let mut from = 0;
        for (target, offset, data) in copies.iter().filter(|(_, _, data)| !data.is_empty()) {
            staging.write(from, data);
            cmd.copy(&staging, from, target, *offset, data.len() as u64);
            from += data.len() as u64;
        }
        self.staging.push(staging);
        Ok(())
    }

    /// Makes every copy so far visible to what follows.
    pub fn finish(&self, cmd: &Commands<'_>, next: Access) {
        barrier::memory(cmd, Access::TRANSFER_WRITE, next);
    }

    /// Bytes waiting in staging buffers.
    pub fn staging_bytes(&self) -> u64 {
        self.staging.iter().map(Buffer::bytes).sum()
    }
}
