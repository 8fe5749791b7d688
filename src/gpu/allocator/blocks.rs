//! The engine's own allocator: blocks of each memory type, and the first piece of one that fits.
//!
//! ```text
//!   memory type 0, buffers   [██░░███░░░░] [░░░░░░░░░░░]        blocks of 64 MiB, less on small heaps
//!   memory type 0, images    [████████░░░]
//!   memory type 2, buffers   [██░░░░░░░░░] [█████████████████]  an object that is larger has a block of its own
//! ```
//!
//! Buffers and images have blocks apart, so that they need not keep `bufferImageGranularity`. A block that nothing lies in
//! is freed, but for one of each kind: a frame that makes its buffers anew takes no memory. Memory types are chosen as
//! gpu-allocator does.

use super::free_list::FreeList;
use super::{Allocation, AllocationError, MemoryAllocator, MemoryReport, MemoryRequest};
use crate::gpu::MemoryLocation;
use crate::gpu::memory::lock;
use ash::vk;
use std::collections::BTreeMap;
use std::ffi::c_void;
use std::ptr::NonNull;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use vk::MemoryPropertyFlags as Flags;

/// Bytes of a block. Few blocks serve a large scene, and a small one takes little.
const BLOCK_BYTES: u64 = 64 << 20;
/// A block takes at most this part of its heap.
const BLOCKS_IN_A_HEAP: u64 = 8;
/// Memory types that need features of their own, or that the GPU alone fills.
const NEVER: Flags =
    Flags::from_raw(Flags::LAZILY_ALLOCATED.as_raw() | Flags::PROTECTED.as_raw() | Flags::DEVICE_COHERENT_AMD.as_raw());

/// An allocator of one device. It frees its memory on drop.
pub struct BlockAllocator {
    device: ash::Device,
    memory: vk::PhysicalDeviceMemoryProperties,
    state: Mutex<State>,
    /// The device's handle is not valid any more.
    gone: AtomicBool,
}

#[derive(Default)]
struct State {
    /// By the key of their pieces.
    blocks: BTreeMap<u64, Block>,
    next: u64,
}

struct Block {
    kind: Kind,
    memory: vk::DeviceMemory,
    mapped: Option<Mapped>,
    free: FreeList,
    /// It was taken for one object.
    is_own: bool,
}

/// Objects of one kind share blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Kind {
    memory_type: u32,
    linear: bool,
}

/// The address of a mapped block.
#[derive(Clone, Copy)]
struct Mapped(NonNull<u8>);

// SAFETY: the device maps the memory for all threads.
unsafe impl Send for Mapped {}

impl BlockAllocator {
    /// An allocator that has taken nothing yet.
    ///
    /// # Safety
    /// `device` was made from `physical`, which belongs to `instance`. It is alive when the allocator is dropped, or else
    /// [`MemoryAllocator::abandon`] was called before.
    pub unsafe fn new(instance: &ash::Instance, physical: vk::PhysicalDevice, device: &ash::Device) -> Self {
        // SAFETY: the caller's promise.
        let memory = unsafe { instance.get_physical_device_memory_properties(physical) };
        Self { device: device.clone(), memory, state: Mutex::default(), gone: AtomicBool::new(false) }
    }

    fn heap_bytes(&self, memory_type: u32) -> u64 {
        let heap = self.memory.memory_types[memory_type as usize].heap_index;
        self.memory.memory_heaps[heap as usize].size
    }

    /// Bytes of the blocks that are tried for a request, and whether each is for it alone.
    fn sizes(&self, memory_type: u32, request: &MemoryRequest<'_>) -> impl Iterator<Item = (u64, bool)> + use<> {
        let size = request.requirements.size;
        let heap = self.heap_bytes(memory_type);
        let shared = BLOCK_BYTES.min(heap / BLOCKS_IN_A_HEAP).min(request.left);
        let shared = (size <= shared).then_some((shared, false));
        shared.into_iter().chain((size <= heap).then_some((size, true)))
    }

    /// Takes memory from the device.
    fn take(&self, kind: Kind, bytes: u64, is_own: bool) -> Result<Block, AllocationError> {
        let failed = |call| move |result| AllocationError::Vulkan { call, result };
        let info = vk::MemoryAllocateInfo::default().allocation_size(bytes).memory_type_index(kind.memory_type);
        // SAFETY: the device is alive while its buffers and images are made.
        let memory = unsafe { self.device.allocate_memory(&info, None) }.map_err(failed("vkAllocateMemory"))?;
        let flags = self.memory.memory_types[kind.memory_type as usize].property_flags;
        let map = || {
            // SAFETY: the memory was just taken, and is not mapped.
            let mapped = unsafe { self.device.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty()) };
            let address = mapped
                .and_then(|at: *mut c_void| NonNull::new(at.cast::<u8>()).ok_or(vk::Result::ERROR_MEMORY_MAP_FAILED));
            address.map(Mapped).map_err(failed("vkMapMemory"))
        };
        let mapped = flags.contains(Flags::HOST_VISIBLE).then(map).transpose();
        let mapped = mapped.inspect_err(|_| {
            // SAFETY: nothing is bound to it.
            unsafe { self.device.free_memory(memory, None) }
        })?;
        Ok(Block { kind, memory, mapped, free: FreeList::new(bytes), is_own })
    }
}

impl State {
    /// A piece of a block that there is.
    fn piece(&mut self, kind: Kind, needs: vk::MemoryRequirements) -> Option<Allocation> {
        let mut of_kind = self.blocks.iter_mut().filter(|(_, block)| block.kind == kind);
        of_kind.find_map(|(key, block)| block.piece(*key, needs))
    }

    /// A piece of a new block.
    fn add(&mut self, mut block: Block, needs: vk::MemoryRequirements) -> Allocation {
        let key = self.next;
        let Some(piece) = block.piece(key, needs) else { unreachable!("a block has room for what it was taken for") };
        self.next += 1;
        self.blocks.insert(key, block);
        piece
    }
}

impl Block {
    fn piece(&mut self, key: u64, needs: vk::MemoryRequirements) -> Option<Allocation> {
        let offset = self.free.take(needs.size, needs.alignment)?;
        // SAFETY: the whole block is mapped, and the offset lies within it.
        let mapped = self.mapped.map(|Mapped(start)| unsafe { start.add(offset as usize) });
        Some(Allocation { memory: self.memory, offset, size: needs.size, mapped, key })
    }

    fn has_room(&self, needs: vk::MemoryRequirements) -> bool {
        self.free.find(needs.size, needs.alignment).is_some()
    }
}

impl AllocationError {
    /// A smaller block, or another memory type, may do.
    fn may_be_mended(&self) -> bool {
        use vk::Result as R;
        let ends = [R::ERROR_OUT_OF_DEVICE_MEMORY, R::ERROR_OUT_OF_HOST_MEMORY, R::ERROR_MEMORY_MAP_FAILED];
        matches!(self, Self::Vulkan { result, .. } if ends.contains(result))
    }
}

/// Memory types for a request, the best first.
fn types(memory: &vk::PhysicalDeviceMemoryProperties, request: &MemoryRequest<'_>) -> Vec<u32> {
    let mapped = Flags::HOST_VISIBLE | Flags::HOST_COHERENT;
    let (needed, better) = match request.location {
        MemoryLocation::Device => (Flags::DEVICE_LOCAL, Flags::empty()),
        MemoryLocation::Upload => (mapped, Flags::DEVICE_LOCAL),
        MemoryLocation::ReadBack => (mapped, Flags::HOST_CACHED),
    };
    let all = (0..).zip(memory.memory_types_as_slice());
    let of_object = all.filter(|(nth, _)| request.requirements.memory_type_bits & 1 << nth != 0);
    let suits = |flags: Flags| flags.contains(needed) && !flags.intersects(NEVER);
    let suiting = of_object.filter(|(_, kind)| suits(kind.property_flags));
    let (best, rest): (Vec<_>, Vec<_>) = suiting.partition(|(_, kind)| kind.property_flags.contains(better));
    best.into_iter().chain(rest).map(|(nth, _)| nth).collect()
}

// SAFETY: `take` maps whole blocks of types that are host-visible, and `types` gives mapped requests only such that are
// coherent, too. `FreeList` gives no byte twice, and pieces at multiples of the alignment.
unsafe impl MemoryAllocator for BlockAllocator {
    fn allocate(&self, request: &MemoryRequest<'_>) -> Result<Allocation, AllocationError> {
        let needs = request.requirements;
        let mut state = lock(&self.state);
        let mut failed = AllocationError::NoMemoryType;
        for memory_type in types(&self.memory, request) {
            let kind = Kind { memory_type, linear: request.linear };
            if let Some(piece) = state.piece(kind, needs) {
                return Ok(piece);
            }
            for (bytes, is_own) in self.sizes(memory_type, request) {
                match self.take(kind, bytes, is_own) {
                    Ok(block) => return Ok(state.add(block, needs)),
                    Err(error) if error.may_be_mended() => failed = error,
                    Err(error) => return Err(error),
                }
            }
        }
        Err(failed)
    }

    unsafe fn free(&self, allocation: Allocation) {
        let mut state = lock(&self.state);
        let Some(block) = state.blocks.get_mut(&allocation.key) else {
            debug_assert!(false, "freed memory that this allocator did not make");
            return;
        };
        block.free.give(allocation.offset, allocation.size);
        if !block.free.is_whole() {
            return;
        }
        let (kind, is_own) = (block.kind, block.is_own);
        let is_spare = |(key, other): (&u64, &Block)| {
            *key != allocation.key && other.kind == kind && !other.is_own && other.free.is_whole()
        };
        if (is_own || state.blocks.iter().any(is_spare))
            && let Some(block) = state.blocks.remove(&allocation.key)
        {
            // SAFETY: nothing is bound to it, as the caller promises.
            unsafe { self.device.free_memory(block.memory, None) }
        }
    }

    fn fits(&self, request: &MemoryRequest<'_>) -> bool {
        let Some(&memory_type) = types(&self.memory, request).first() else { return false };
        let kind = Kind { memory_type, linear: request.linear };
        let state = lock(&self.state);
        state.blocks.values().any(|block| block.kind == kind && block.has_room(request.requirements))
    }

    fn report(&self) -> MemoryReport {
        let state = lock(&self.state);
        let of = |block: &Block| MemoryReport { taken: block.free.all(), used: block.free.all() - block.free.free() };
        let add = |a: MemoryReport, b: MemoryReport| MemoryReport { taken: a.taken + b.taken, used: a.used + b.used };
        state.blocks.values().map(of).fold(MemoryReport::default(), add)
    }

    fn abandon(&self) {
        self.gone.store(true, Ordering::Relaxed);
    }
}

impl Drop for BlockAllocator {
    fn drop(&mut self) {
        if self.gone.load(Ordering::Relaxed) {
            return; // the memory was freed with its device
        }
        for block in std::mem::take(&mut lock(&self.state).blocks).into_values() {
            // SAFETY: nothing is bound to it any more: the allocator's users are gone.
            unsafe { self.device.free_memory(block.memory, None) }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::Pool;

    const MAPPED: Flags = Flags::from_raw(Flags::HOST_VISIBLE.as_raw() | Flags::HOST_COHERENT.as_raw());

    fn memory(all: &[Flags]) -> vk::PhysicalDeviceMemoryProperties {
        let mut memory =
            vk::PhysicalDeviceMemoryProperties { memory_type_count: all.len() as u32, ..Default::default() };
        for (nth, flags) in all.iter().enumerate() {
            memory.memory_types[nth].property_flags = *flags;
        }
        memory
    }

    fn request(location: MemoryLocation, memory_type_bits: u32) -> MemoryRequest<'static> {
        let requirements = vk::MemoryRequirements { size: 1, alignment: 1, memory_type_bits };
        MemoryRequest { name: "one", pool: Pool::Transient, requirements, location, linear: true, left: u64::MAX }
    }

    #[test]
    fn memory_types_come_in_order_of_preference() {
        // in the order of a driver's list: if a type has all flags of another and more, it comes later
        let all = memory(&[
            Flags::DEVICE_LOCAL,
            MAPPED,
            MAPPED | Flags::HOST_CACHED,
            MAPPED | Flags::DEVICE_LOCAL,
            Flags::DEVICE_LOCAL | Flags::LAZILY_ALLOCATED,
            Flags::HOST_VISIBLE | Flags::HOST_CACHED,
        ]);
        let of = |location, bits| types(&all, &request(location, bits));
        assert_eq!(of(MemoryLocation::Device, u32::MAX), [0, 3]);
        assert_eq!(of(MemoryLocation::Upload, u32::MAX), [3, 1, 2]);
        assert_eq!(of(MemoryLocation::ReadBack, u32::MAX), [2, 1, 3]);
        // what the object does not take is left out
        assert_eq!(of(MemoryLocation::Upload, 0b10_0010), [1]);
        assert_eq!(of(MemoryLocation::Device, 0b11_0110), [0; 0]);
    }
}
