//! Copies host data into device-local buffers, through staging memory of a bounded size.
//!
//! ```text
//!   data ──▶ Uploads ──record: as many bytes as may be──▶ Staging ──copies──▶ buffers
//!               └─ what is left, for the next frame
//! ```

use super::{Access, Buffer, BufferInfo, Commands, Device, GpuError, MemoryLocation, Pool, barrier};
use ash::vk;
use bytemuck::Pod;
use std::borrow::Cow;
use std::collections::VecDeque;

/// Most bytes of staging memory of a renderer. Less makes more frames copy before the first picture; more takes memory that
/// is of no use later, and that some devices map little of.
pub(super) const STAGING_BYTES: u64 = 64 << 20;

/// Copies to be recorded, in order. The buffers that they go to outlive it.
#[derive(Debug, Default)]
pub struct Uploads<'d> {
    pieces: VecDeque<Piece<'d>>,
}

/// Bytes for a place in a buffer.
#[derive(Debug)]
struct Piece<'d> {
    to: vk::Buffer,
    at: u64,
    bytes: Cow<'d, [u8]>,
    /// Bytes at the beginning that have been copied.
    done: usize,
}

impl Piece<'_> {
    fn rest(&self) -> &[u8] {
        &self.bytes[self.done..]
    }

    fn into_owned(self) -> Piece<'static> {
        let Self { to, at, bytes, done } = self;
        match bytes {
            Cow::Owned(bytes) => Piece { to, at, bytes: Cow::Owned(bytes), done },
            Cow::Borrowed(bytes) => {
                Piece { to, at: at + done as u64, bytes: Cow::Owned(bytes[done..].to_vec()), done: 0 }
            }
        }
    }
}

/// The staging memory of recorded copies. Drop it after the fence.
#[derive(Debug, Default)]
pub struct Staging {
    buffer: Option<Buffer>,
    bytes: u64,
}

impl<'d> Uploads<'d> {
    /// Nothing to copy.
    pub fn new() -> Self {
        Self::default()
    }

    /// Makes a buffer for `data`, and adds the copy.
    ///
    /// # Errors
    /// See [`Buffer::new`].
    pub fn buffer<T: Pod>(
        &mut self,
        device: &Device,
        pool: Pool,
        name: &str,
        usage: vk::BufferUsageFlags,
        data: &'d [T],
    ) -> Result<Buffer, GpuError> {
        self.buffer_of(device, pool, name, usage, Cow::Borrowed(bytemuck::cast_slice(data)))
    }

    /// As [`buffer`](Self::buffer), of data that nothing else holds.
    ///
    /// # Errors
    /// See [`Buffer::new`].
    pub fn owned_buffer<T: Pod>(
        &mut self,
        device: &Device,
        pool: Pool,
        name: &str,
        usage: vk::BufferUsageFlags,
        data: &[T],
    ) -> Result<Buffer, GpuError> {
        self.buffer_of(device, pool, name, usage, Cow::Owned(bytemuck::cast_slice(data).to_vec()))
    }

    fn buffer_of(
        &mut self,
        device: &Device,
        pool: Pool,
        name: &str,
        usage: vk::BufferUsageFlags,
        data: Cow<'d, [u8]>,
    ) -> Result<Buffer, GpuError> {
        // read when a larger one takes its place
        let copied = vk::BufferUsageFlags::TRANSFER_DST | vk::BufferUsageFlags::TRANSFER_SRC;
        let (bytes, usage, location) = (data.len() as u64, usage | copied, MemoryLocation::Device);
        let buffer = Buffer::new(device, &BufferInfo { name, bytes, usage, pool, location })?;
        self.push(&buffer, 0, data);
        Ok(buffer)
    }

    /// Adds the copy of `data` to `offset` bytes of `target`.
    ///
    /// # Panics
    /// When `data` does not fit.
    pub fn write(&mut self, target: &Buffer, offset: u64, data: &'d [u8]) {
        self.push(target, offset, Cow::Borrowed(data));
    }

    fn push(&mut self, target: &Buffer, at: u64, bytes: Cow<'d, [u8]>) {
        let fits = at + bytes.len() as u64 <= target.bytes();
        assert!(fits, "{} bytes at {at} do not fit in `{}`", bytes.len(), target.name());
        if !bytes.is_empty() {
            self.pieces.push_back(Piece { to: target.handle(), at, bytes, done: 0 });
        }
    }

    /// Bytes that are not copied yet.
    pub fn bytes(&self) -> u64 {
        self.pieces.iter().map(|piece| piece.rest().len() as u64).sum()
    }

    /// Records the copies of the first bytes, at most `most` rounded down to [`Buffer::LEAST_BYTES`]:
    /// [`Access::TRANSFER_WRITE`]. They stay until [`advance`](Self::advance): a frame that fails has copied nothing.
    ///
    /// # Errors
    /// See [`Buffer::new`], for the staging buffer.
    pub fn record(&self, cmd: &Commands<'_>, name: &str, most: u64) -> Result<Staging, GpuError> {
        let bytes = self.bytes().min(most / Buffer::LEAST_BYTES * Buffer::LEAST_BYTES);
        if bytes == 0 {
            return Ok(Staging::default());
        }
        let (name, usage) = (format!("staging of {name}"), vk::BufferUsageFlags::TRANSFER_SRC);
        let info = BufferInfo { name: &name, bytes, usage, pool: Pool::Staging, location: MemoryLocation::Upload };
        let mut staging = Buffer::new(cmd.device(), &info)?;
        let mut from = 0;
        for piece in &self.pieces {
            let part = piece.rest();
            let part = &part[..part.len().min((bytes - from) as usize)];
            staging.write(from, part);
            cmd.copy_to(&staging, from, piece.to, piece.at + piece.done as u64, part.len() as u64);
            from += part.len() as u64;
            if from == bytes {
                break;
            }
        }
        Ok(Staging { buffer: Some(staging), bytes })
    }

    /// Forgets the copies that were recorded.
    pub fn advance(&mut self, recorded: &Staging) {
        let mut bytes = recorded.bytes as usize;
        while let Some(piece) = self.pieces.front_mut() {
            let rest = piece.rest().len();
            if bytes < rest {
                piece.done += bytes;
                return;
            }
            bytes -= rest;
            self.pieces.pop_front();
        }
    }

    /// The same copies, of bytes of their own.
    pub fn into_owned(self) -> Uploads<'static> {
        Uploads { pieces: self.pieces.into_iter().map(Piece::into_owned).collect() }
    }
}

impl Staging {
    /// Makes the copies visible to what follows.
    pub fn finish(&self, cmd: &Commands<'_>, next: Access) {
        if self.buffer.is_some() {
            barrier::memory(cmd, Access::TRANSFER_WRITE, next);
        }
    }

    /// Bytes that were recorded.
    pub fn bytes(&self) -> u64 {
        self.bytes
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Bytes are recorded in order, whatever the sizes of the pieces and of what is recorded at a time.
    #[test]
    fn what_was_recorded_is_forgotten_byte_by_byte() {
        let data: Vec<u8> = (0..15).collect();
        let piece = |range: std::ops::Range<usize>| Piece {
            to: vk::Buffer::null(),
            at: 100 + range.start as u64,
            bytes: Cow::Borrowed(&data[range]),
            done: 0,
        };
        let mut uploads = Uploads { pieces: [piece(0..5), piece(5..12), piece(12..15)].into() };
        let mut copied = 0;
        for bytes in [4, 4, 0, 4, 3] {
            assert_eq!(uploads.bytes(), 15 - copied);
            let left = uploads.pieces.iter().flat_map(|piece| {
                let first = piece.at + piece.done as u64;
                (first..).zip(piece.rest()).map(|(at, byte)| (at - 100, u64::from(*byte))).collect::<Vec<_>>()
            });
            // each byte is its own place
            assert_eq!(left.collect::<Vec<_>>(), (copied..15).map(|k| (k, k)).collect::<Vec<_>>());
            uploads.advance(&Staging { buffer: None, bytes });
            uploads = uploads.into_owned();
            copied += bytes;
        }
        assert!(uploads.pieces.is_empty());
    }
}
