//! Device memory in four pools by lifetime; each pool counts its bytes.
//!
//! ```text
//!   persistent   with the scene          control points, trim curves, trees
//!   ring         one per frame slot      what the CPU writes or reads each frame
//!   transient    with the frame's size   visibility buffer, counters, tables
//!   staging      until a frame is done   bytes on their way to the other pools
//! ```

use super::{Allocation, Device, GpuError, MemoryRequest};
use ash::vk;
use std::mem::ManuallyDrop;
use std::slice;
use std::sync::PoisonError;

/// The lifetime of a resource. Its bytes are counted in this pool (see [`Device::pool_bytes`]).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pool {
    /// As long as the scene.
    Persistent,
    /// As long as the renderer, one copy per frame slot.
    Ring,
    /// As long as the frame's size stays, or shorter.
    Transient,
    /// Until the frame that copies it has finished.
    Staging,
}

impl Pool {
    /// Every pool, in the order of [`Device::pool_bytes`].
    pub const ALL: [Self; 4] = [Self::Persistent, Self::Ring, Self::Transient, Self::Staging];

    /// `persistent`, `ring`, `transient` or `staging`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Persistent => "persistent",
            Self::Ring => "ring",
            Self::Transient => "transient",
            Self::Staging => "staging",
        }
    }
}

/// Where memory is, and whether the CPU can access it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MemoryLocation {
    /// Fastest for the GPU; not mapped.
    Device,
    /// Mapped for the CPU to write.
    Upload,
    /// Mapped for the CPU to read.
    ReadBack,
}

/// A piece of device memory, counted in its pool and freed on drop.
#[derive(Debug)]
pub(crate) struct Memory {
    device: Device,
    allocation: ManuallyDrop<Allocation>,
    pool: Pool,
}

impl Memory {
    /// Its size.
    pub(crate) fn bytes(&self) -> u64 {
        self.allocation.size
    }

    pub(crate) fn new(
        device: &Device,
        name: &str,
        requirements: vk::MemoryRequirements,
        pool: Pool,
        location: MemoryLocation,
        linear: bool,
    ) -> Result<Self, GpuError> {
        let request = MemoryRequest { name, pool, requirements, location, linear, left: 0 };
        let request = MemoryRequest { left: device.heaps().check(device, &request)?, ..request };
        let of_allocator = |source| GpuError::of_allocator(source, name, requirements.size);
        let allocation = device.allocator().allocate(&request).map_err(of_allocator)?;
        device.count_bytes(pool, allocation.size as i64);
        Ok(Self { device: device.clone(), allocation: ManuallyDrop::new(allocation), pool })
    }

    pub(crate) fn raw(&self) -> (vk::DeviceMemory, u64) {
        (self.allocation.memory, self.allocation.offset)
    }

    pub(crate) fn mapped(&self) -> Option<&[u8]> {
        let bytes = self.allocation.size as usize;
        // SAFETY: as `MemoryAllocator` promises.
        self.allocation.mapped.map(|at| unsafe { slice::from_raw_parts(at.as_ptr(), bytes) })
    }

    pub(crate) fn mapped_mut(&mut self) -> Option<&mut [u8]> {
        let bytes = self.allocation.size as usize;
        // SAFETY: as `MemoryAllocator` promises.
        self.allocation.mapped.map(|at| unsafe { slice::from_raw_parts_mut(at.as_ptr(), bytes) })
    }

    pub(crate) fn pool(&self) -> Pool {
        self.pool
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        self.device.count_bytes(self.pool, -(self.allocation.size as i64));
        // SAFETY: the allocation is taken once, here.
        let allocation = unsafe { ManuallyDrop::take(&mut self.allocation) };
        if self.device.living().is_none() {
            return; // the memory was freed with its device
        }
        // SAFETY: of this allocator; what was bound to it is destroyed before, as `Buffer` and `Image` see to.
        unsafe { self.device.allocator().free(allocation) }
    }
}

/// Locks a mutex; a panic elsewhere does not make memory bookkeeping unusable.
pub(crate) fn lock<T>(mutex: &std::sync::Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
