//! Refuses an object that exceeds the memory budget: the host's budget, or the driver's budget of each heap.
//!
//! ```text
//!   the host's budget      all of the engine's memory on this device  + the new object  <=  budget
//!   and, of the heap with the most room among those of the object's memory types:
//!     VK_EXT_memory_budget   the process's memory in that heap        + the new object  <=  heapBudget
//!     without it             all of the engine's memory               + the new object  <=  size of the heap
//! ```
//!
//! The driver's figures are read again for each object, because other programs take memory, too. The allocator may try
//! several memory types, so an object is refused only if none of their heaps has room. The allocator takes memory in
//! blocks, which the driver counts whole: an object that has room in a block takes nothing of a heap, and is not refused.

use super::{BudgetOwner, Device, GpuError, MemoryLocation, MemoryRequest};
use ash::vk;
use vk::MemoryPropertyFlags as Kind;

/// Heaps of a device, and the host's budget.
pub(super) struct Heaps {
    instance: ash::Instance,
    physical: vk::PhysicalDevice,
    memory: vk::PhysicalDeviceMemoryProperties,
    tells_budget: bool,
    most: Option<u64>,
}

/// Bytes left, of `most`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Room {
    left: u64,
    most: u64,
}

impl Heaps {
    /// # Safety
    /// `physical` belongs to `instance`, which outlives the value.
    pub(super) unsafe fn new(instance: &ash::Instance, physical: vk::PhysicalDevice, most: Option<u64>) -> Self {
        // SAFETY: the caller's promise.
        let (memory, extensions) = unsafe {
            (
                instance.get_physical_device_memory_properties(physical),
                instance.enumerate_device_extension_properties(physical).unwrap_or_default(),
            )
        };
        let tells = |e: &vk::ExtensionProperties| e.extension_name_as_c_str() == Ok(ash::ext::memory_budget::NAME);
        let tells_budget = extensions.iter().any(tells);
        Self { instance: instance.clone(), physical, memory, tells_budget, most }
    }

    pub(super) fn most(&self) -> Option<u64> {
        self.most
    }

    /// Refuses an object that does not fit; else the bytes that are left.
    pub(super) fn check(&self, device: &Device, request: &MemoryRequest<'_>) -> Result<u64, GpuError> {
        let taken = device.pool_bytes().iter().map(|(_, bytes)| bytes).sum();
        let (bytes, types) = (request.requirements.size, request.requirements.memory_type_bits);
        let over = |room: Room, of| {
            let (resource, Room { left, most }) = (request.name.to_owned(), room);
            Err(GpuError::OverBudget { resource, bytes, left, most, of })
        };
        let mut least = u64::MAX;
        if let Some(most) = self.most {
            let own = Room { left: most.saturating_sub(taken), most };
            if bytes > own.left {
                return over(own, BudgetOwner::Host);
            }
            least = own.left;
        }
        // without such a memory type the allocator returns the error
        if let Some(heap) = self.of_heaps(types, request.location, taken) {
            if bytes > heap.left && !device.allocator().fits(request) {
                return over(heap, BudgetOwner::Heap);
            }
            least = least.min(heap.left);
        }
        Ok(least)
    }

    /// The heap with the most room, among those of an object's memory types.
    fn of_heaps(&self, types: u32, location: MemoryLocation, taken: u64) -> Option<Room> {
        let mut budget = vk::PhysicalDeviceMemoryBudgetPropertiesEXT::default();
        if self.tells_budget {
            let mut memory = vk::PhysicalDeviceMemoryProperties2::default().push_next(&mut budget);
            // SAFETY: as `new` demands; the device knows the struct.
            unsafe { self.instance.get_physical_device_memory_properties2(self.physical, &mut memory) };
        }
        let of_heap = |heap: u32| {
            let (budget, used) = (budget.heap_budget[heap as usize], budget.heap_usage[heap as usize]);
            let (most, used) =
                if self.tells_budget { (budget, used) } else { (self.memory.memory_heaps[heap as usize].size, taken) };
            Room { left: most.saturating_sub(used), most }
        };
        heaps_of(&self.memory, types, location).map(of_heap).max_by_key(|room| room.left)
    }
}

/// Heaps of the memory types that the allocator may use.
fn heaps_of(
    memory: &vk::PhysicalDeviceMemoryProperties,
    types: u32,
    location: MemoryLocation,
) -> impl Iterator<Item = u32> {
    let wanted = match location {
        MemoryLocation::Device => Kind::DEVICE_LOCAL,
        MemoryLocation::Upload | MemoryLocation::ReadBack => Kind::HOST_VISIBLE | Kind::HOST_COHERENT,
    };
    let all = memory.memory_types_as_slice().iter().enumerate();
    let may = move |(i, kind): &(usize, &vk::MemoryType)| types & 1 << i != 0 && kind.property_flags.contains(wanted);
    all.filter(may).map(|(_, kind)| kind.heap_index)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_object_comes_from_heaps_of_its_kind() {
        let mut memory = vk::PhysicalDeviceMemoryProperties { memory_type_count: 3, ..Default::default() };
        let kinds = [Kind::DEVICE_LOCAL, Kind::HOST_VISIBLE | Kind::HOST_COHERENT, Kind::HOST_VISIBLE];
        for (i, kind) in kinds.into_iter().enumerate() {
            memory.memory_types[i] = vk::MemoryType { property_flags: kind, heap_index: 10 + i as u32 };
        }
        let heaps = |types, location| heaps_of(&memory, types, location).collect::<Vec<_>>();
        assert_eq!(heaps(0b111, MemoryLocation::Device), [10]);
        assert_eq!(heaps(0b111, MemoryLocation::Upload), [11]);
        assert_eq!(heaps(0b101, MemoryLocation::ReadBack), [0; 0]);
    }
}
