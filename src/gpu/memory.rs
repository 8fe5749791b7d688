//! Device memory in three pools by lifetime; each pool counts its bytes.
//!
//! ```text
//!   persistent   with the scene          control points, trim curves, trees
//!   ring         one per frame slot      what the CPU writes or reads each frame
//!   transient    with the frame's size   visibility buffer, counters, tables
//! ```

use super::{Device, GpuError};
use ash::vk;
use gpu_allocator::MemoryLocation as AllocatorLocation;
use gpu_allocator::vulkan::{Allocation, AllocationCreateDesc, AllocationScheme};
use std::mem::ManuallyDrop;
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
}

impl Pool {
    /// Every pool, in the order of [`Device::pool_bytes`].
    pub const ALL: [Self; 3] = [Self::Persistent, Self::Ring, Self::Transient];

    /// `persistent`, `ring` or `transient`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Persistent => "persistent",
            Self::Ring => "ring",
            Self::Transient => "transient",
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
        self.allocation.size()
    }

    pub(crate) fn new(
        device: &Device,
        name: &str,
        requirements: vk::MemoryRequirements,
        pool: Pool,
        location: MemoryLocation,
        linear: bool,
    ) -> Result<Self, GpuError> {
        let kind = match location {
            MemoryLocation::Device => AllocatorLocation::GpuOnly,
            MemoryLocation::Upload => AllocatorLocation::CpuToGpu,
            MemoryLocation::ReadBack => AllocatorLocation::GpuToCpu,
        };
        let allocation_scheme = AllocationScheme::GpuAllocatorManaged;
        let description = AllocationCreateDesc { name, requirements, location: kind, linear, allocation_scheme };
        let size = requirements.size;
        device.heaps().check(device, name, (requirements.memory_type_bits, location), size)?;
        let of_allocator = |source| GpuError::of_allocator(source, name, size);
        let allocation = device.allocator().allocate(&description).map_err(of_allocator)?;
        device.count_bytes(pool, allocation.size() as i64);
        Ok(Self { device: device.clone(), allocation: ManuallyDrop::new(allocation), pool })
    }

    pub(crate) fn raw(&self) -> (vk::DeviceMemory, u64) {
        // SAFETY: the handle is only used to bind a resource that is destroyed before this memory.
        (unsafe { self.allocation.memory() }, self.allocation.offset())
    }

    pub(crate) fn mapped(&self) -> Option<&[u8]> {
        self.allocation.mapped_slice()
    }

    pub(crate) fn mapped_mut(&mut self) -> Option<&mut [u8]> {
        self.allocation.mapped_slice_mut()
    }

    pub(crate) fn pool(&self) -> Pool {
        self.pool
    }
}

impl Drop for Memory {
    fn drop(&mut self) {
        self.device.count_bytes(self.pool, -(self.allocation.size() as i64));
        // SAFETY: the allocation is taken once, here.
        let allocation = unsafe { ManuallyDrop::take(&mut self.allocation) };
        if self.device.living().is_none() {
            return; // the memory was freed with its device
        }
        // `free` fails only for memory of another allocator, which `new` rules out.
        let freed = self.device.allocator().free(allocation);
        debug_assert!(freed.is_ok(), "freed memory that this allocator did not make");
    }
}

/// Locks a mutex; a panic elsewhere does not make memory bookkeeping unusable.
pub(crate) fn lock<T>(mutex: &std::sync::Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
