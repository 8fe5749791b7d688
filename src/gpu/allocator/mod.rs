//! Where the memory of buffers and images comes from: the host's allocator, or one of the engine's own.
//!
//! ```text
//!   Buffer, Image ──▶ Memory ──budget──▶ MemoryAllocator ◀── BlockAllocator   the engine's own
//!                                                        ◀── GpuAllocator     a gpu-allocator that the host shares
//!                                                        ◀── the host's own
//! ```
//!
//! `headless` has the engine's own: it takes no crate, it computes what fits into the blocks that it has, and it is the
//! same with and without the feature `gpu-allocator`.

mod blocks;
mod free_list;
#[cfg(feature = "gpu-allocator")]
mod shared;

pub use blocks::BlockAllocator;
#[cfg(feature = "gpu-allocator")]
pub use shared::GpuAllocator;

use super::{MemoryLocation, Pool};
use ash::vk;
use std::error::Error;
use std::ptr::NonNull;

/// What a buffer or an image asks an allocator for.
#[derive(Clone, Copy, Debug)]
pub struct MemoryRequest<'a> {
    /// Name of the buffer or image.
    pub name: &'a str,
    /// Its lifetime.
    pub pool: Pool,
    /// Size, alignment and memory types, as Vulkan states them for the object.
    pub requirements: vk::MemoryRequirements,
    /// Where the memory is. If it is mapped, its memory type is coherent.
    pub location: MemoryLocation,
    /// A buffer; otherwise an image of optimal tiling. In one `VkDeviceMemory` the two keep `bufferImageGranularity`
    /// apart.
    pub linear: bool,
    /// Bytes left in the budget: the most that should be taken from the device for this request. Fewer than the size
    /// where [`MemoryAllocator::fits`] said that nothing is taken.
    pub left: u64,
}

/// A piece of device memory.
#[derive(Debug)]
pub struct Allocation {
    /// The memory object.
    pub memory: vk::DeviceMemory,
    /// Where the piece begins, bytes.
    pub offset: u64,
    /// Its bytes, at least those of the request.
    pub size: u64,
    /// The address of its first byte, if it is mapped.
    pub mapped: Option<NonNull<u8>>,
    /// The allocator's own number for it.
    pub key: u64,
}

// SAFETY: an address of memory that the device maps for all threads. Writes go through `&mut` of the one owner.
unsafe impl Send for Allocation {}
// SAFETY: as above.
unsafe impl Sync for Allocation {}

/// The bytes of an allocator, whoever uses it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MemoryReport {
    /// Of the memory objects that it has taken from the device.
    pub taken: u64,
    /// Of the pieces in them that are allocated.
    pub used: u64,
}

/// Why there is no memory.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum AllocationError {
    /// A Vulkan function failed.
    #[error("{call}: {result}")]
    Vulkan {
        /// The function, as Vulkan spells it.
        call: &'static str,
        /// What it returned.
        result: vk::Result,
    },
    /// The device has no memory type for the object.
    #[error("the device has no such memory type")]
    NoMemoryType,
    /// Another reason of the allocator's.
    #[error("{0}")]
    Other(#[source] Box<dyn Error + Send + Sync>),
}

/// Takes device memory for buffers and images. The host's is in [`HostDevice::allocator`](super::HostDevice::allocator).
///
/// A host may count by [`MemoryRequest::pool`] and [`name`](MemoryRequest::name). Several threads may call at a time.
///
/// # Safety
/// [`allocate`](Self::allocate) returns memory of the device, of a type that the request allows. No other piece overlaps
/// it until it is freed. It lies at a multiple of the alignment. If it has an address, all of it is mapped from there,
/// coherently, and stays so. Pieces for [`MemoryLocation::Upload`] and [`MemoryLocation::ReadBack`] have one.
pub unsafe trait MemoryAllocator: Send + Sync {
    /// Takes a piece.
    ///
    /// # Errors
    /// [`AllocationError`]; nothing was taken.
    fn allocate(&self, request: &MemoryRequest<'_>) -> Result<Allocation, AllocationError>;

    /// Takes a piece back.
    ///
    /// # Safety
    /// The piece is one of this allocator's, and nothing is bound to it any more. It is freed once.
    unsafe fn free(&self, allocation: Allocation);

    /// The request takes nothing from the device, because it fits into memory that was taken before. Then it is not
    /// refused when the device's memory is used up. `false` is always allowed.
    fn fits(&self, request: &MemoryRequest<'_>) -> bool {
        let _ = request;
        false
    }

    /// Its bytes.
    fn report(&self) -> MemoryReport;

    /// The device's handle is not valid any more: memory must not be freed. An allocator of the host's needs no word.
    fn abandon(&self) {}
}
