//! A gpu-allocator that the host shares with the engine.
//!
//! gpu-allocator does not tell which memory type a block has. A request for the same location and the same memory types as
//! a living piece gets the memory type of that piece, so the piece's block has room for it or has not. A piece is found in
//! gpu-allocator's report by the number at the end of its name.

use super::{Allocation, AllocationError, MemoryAllocator, MemoryReport, MemoryRequest};
use crate::gpu::MemoryLocation;
use crate::gpu::memory::lock;
use ash::vk;
use gpu_allocator::vulkan::{self, AllocationCreateDesc, AllocationScheme, Allocator};
use gpu_allocator::{AllocationError as Reason, AllocationReport, MemoryLocation as Location};
use std::collections::HashMap;
use std::ptr::NonNull;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex};

/// Between a name and its number.
const MARK: &str = " #";
/// The largest `bufferImageGranularity` that Vulkan allows (1.3, "Limit Requirements").
const MOST_GRANULARITY: u64 = 1 << 17;

/// A gpu-allocator as the engine's allocator. The host may use it meanwhile.
pub struct GpuAllocator {
    shared: Arc<Mutex<Allocator>>,
    /// By their keys.
    living: Mutex<HashMap<u64, Piece>>,
}

struct Piece {
    allocation: vulkan::Allocation,
    kind: Kind,
}

/// Requests of one kind get one memory type.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Kind {
    location: MemoryLocation,
    memory_types: u32,
}

impl Kind {
    fn of(request: &MemoryRequest<'_>) -> Self {
        Self { location: request.location, memory_types: request.requirements.memory_type_bits }
    }
}

impl GpuAllocator {
    /// For the device of this allocator.
    pub fn new(shared: Arc<Mutex<Allocator>>) -> Self {
        Self { shared, living: Mutex::default() }
    }
}

// SAFETY: gpu-allocator's pieces are disjoint and aligned; memory for `CpuToGpu` and `GpuToCpu` is coherent and mapped.
unsafe impl MemoryAllocator for GpuAllocator {
    fn allocate(&self, request: &MemoryRequest<'_>) -> Result<Allocation, AllocationError> {
        /// Numbers differ between all that share an allocator.
        static NEXT: AtomicU64 = AtomicU64::new(0);
        let key = NEXT.fetch_add(1, Ordering::Relaxed);
        let description = AllocationCreateDesc {
            name: &format!("{}{MARK}{key}", request.name),
            requirements: request.requirements,
            location: match request.location {
                MemoryLocation::Device => Location::GpuOnly,
                MemoryLocation::Upload => Location::CpuToGpu,
                MemoryLocation::ReadBack => Location::GpuToCpu,
            },
            linear: request.linear,
            allocation_scheme: AllocationScheme::GpuAllocatorManaged,
        };
        let allocation = lock(&self.shared).allocate(&description).map_err(error)?;
        // SAFETY: the handle is only used to bind an object that is destroyed before the piece is freed.
        let memory = unsafe { allocation.memory() };
        let (offset, size) = (allocation.offset(), allocation.size());
        let mapped = allocation.mapped_ptr().map(NonNull::cast);
        lock(&self.living).insert(key, Piece { allocation, kind: Kind::of(request) });
        Ok(Allocation { memory, offset, size, mapped, key })
    }

    unsafe fn free(&self, allocation: Allocation) {
        let piece = lock(&self.living).remove(&allocation.key);
        let freed = piece.map(|piece| lock(&self.shared).free(piece.allocation));
        debug_assert!(matches!(freed, Some(Ok(()))), "freed memory that this allocator did not make");
    }

    fn fits(&self, request: &MemoryRequest<'_>) -> bool {
        let report = lock(&self.shared).generate_report();
        let living = lock(&self.living);
        let is_alike = |found: &AllocationReport| {
            let key = found.name.rsplit_once(MARK).and_then(|(_, key)| key.parse().ok());
            let piece = key.and_then(|key: u64| living.get(&key));
            piece.is_some_and(|own| own.kind == Kind::of(request) && own.allocation.offset() == found.offset)
        };
        let needs = request.requirements;
        // buffers beside images start on pages of their own
        let wanted = needs.size + needs.alignment + 2 * MOST_GRANULARITY;
        report.blocks.iter().any(|block| {
            let pieces = &report.allocations[block.allocations.clone()];
            pieces.iter().any(is_alike) && largest_gap(block.size, pieces) >= wanted
        })
    }

    fn report(&self) -> MemoryReport {
        let report = lock(&self.shared).generate_report();
        MemoryReport { taken: report.total_capacity_bytes, used: report.total_allocated_bytes }
    }
}

/// Bytes of the largest free range of a block.
fn largest_gap(bytes: u64, pieces: &[AllocationReport]) -> u64 {
    let mut taken: Vec<_> = pieces.iter().map(|piece| (piece.offset, piece.offset + piece.size)).collect();
    taken.sort_unstable();
    let starts = taken.iter().map(|(start, _)| *start).chain([bytes]);
    let ends = [0].into_iter().chain(taken.iter().map(|(_, end)| *end));
    starts.zip(ends).map(|(start, end)| start.saturating_sub(end)).max().unwrap_or(0)
}

/// gpu-allocator has a variant for the commonest result of `vkAllocateMemory`; other results, and those of `vkMapMemory`,
/// are only in its text.
fn error(reason: Reason) -> AllocationError {
    use vk::Result as R;
    const NAMED: [R; 3] = [R::ERROR_DEVICE_LOST, R::ERROR_OUT_OF_HOST_MEMORY, R::ERROR_OUT_OF_DEVICE_MEMORY];
    let call = if matches!(reason, Reason::FailedToMap(_)) { "vkMapMemory" } else { "vkAllocateMemory" };
    let result = match &reason {
        Reason::OutOfMemory => Some(R::ERROR_OUT_OF_DEVICE_MEMORY),
        Reason::FailedToMap(words) | Reason::Internal(words) => {
            let is_named = |result: &R| words.contains(&result.to_string()) || words.contains(&format!("{result:?}"));
            NAMED.into_iter().find(is_named)
        }
        Reason::NoCompatibleMemoryTypeFound => return AllocationError::NoMemoryType,
        _ => None,
    };
    match result {
        Some(result) => AllocationError::Vulkan { call, result },
        None => AllocationError::Other(Box::new(reason)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_largest_gap_is_found_wherever_it_is() {
        let piece = |offset, size| AllocationReport { name: String::new(), offset, size };
        assert_eq!(largest_gap(100, &[]), 100);
        assert_eq!(largest_gap(100, &[piece(60, 10), piece(0, 40)]), 30);
        assert_eq!(largest_gap(100, &[piece(60, 10), piece(0, 20)]), 40);
        assert_eq!(largest_gap(100, &[piece(90, 10), piece(30, 60)]), 30);
        assert_eq!(largest_gap(100, &[piece(0, 100)]), 0);
    }

    #[test]
    fn results_in_words_are_typed() {
        let out = vk::Result::ERROR_OUT_OF_HOST_MEMORY;
        for (reason, of_call) in [
            (Reason::FailedToMap(out.to_string()), "vkMapMemory"),
            (Reason::Internal(format!("Unexpected error in vkAllocateMemory: {out:?}")), "vkAllocateMemory"),
        ] {
            let typed = error(reason);
            assert!(
                matches!(&typed, AllocationError::Vulkan { call, result } if (*call, *result) == (of_call, out)),
                "{typed:?}"
            );
        }
        assert!(matches!(error(Reason::NoCompatibleMemoryTypeFound), AllocationError::NoMemoryType));
        assert!(matches!(error(Reason::InvalidAllocationCreateDesc), AllocationError::Other(_)));
    }
}
