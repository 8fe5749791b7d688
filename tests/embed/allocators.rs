//! Memory from allocators of several kinds, and a device by its handles: the picture is the same.

use crate::host::Host;
use crate::picture::{SIZE, camera, draw, renderer_on};
use crate::shapes;
use crate::targets::Targets;
use ash::vk;
use ash::vk::Handle;
use selvedge::gpu::{
    Allocation, AllocationError, HostDevice, MemoryAllocator, MemoryLocation, MemoryReport, MemoryRequest, Pool,
};
use std::collections::{BTreeMap, BTreeSet};
use std::ptr::NonNull;
use std::sync::{Arc, Mutex};
use vk::MemoryPropertyFlags as Flags;

const FORMAT: vk::Format = vk::Format::R8G8B8A8_UNORM;

/// A host's own allocator, as plain as can be: a memory object for each piece.
struct Plain {
    device: ash::Device,
    memory: vk::PhysicalDeviceMemoryProperties,
    state: Mutex<State>,
}

#[derive(Default)]
struct State {
    /// Bytes by key.
    living: BTreeMap<u64, u64>,
    /// Names of the pools that asked.
    pools: BTreeSet<&'static str>,
}

// SAFETY: each piece is a memory object of its own; types of mapped ones are coherent.
unsafe impl MemoryAllocator for Plain {
    fn allocate(&self, request: &MemoryRequest<'_>) -> Result<Allocation, AllocationError> {
        let needs = request.requirements;
        assert!(request.left >= needs.size && !request.name.is_empty(), "{request:?}");
        let is_mapped = request.location != MemoryLocation::Device;
        let wanted = if is_mapped { Flags::HOST_VISIBLE | Flags::HOST_COHERENT } else { Flags::DEVICE_LOCAL };
        let all = self.memory.memory_types_as_slice();
        let suits = |nth: &usize| needs.memory_type_bits & 1 << nth != 0 && all[*nth].property_flags.contains(wanted);
        let memory_type = (0..all.len()).find(suits).ok_or(AllocationError::NoMemoryType)?;
        let info = vk::MemoryAllocateInfo::default().allocation_size(needs.size).memory_type_index(memory_type as u32);
        let failed = |call| move |result| AllocationError::Vulkan { call, result };
        // SAFETY: the device is alive.
        let memory = unsafe { self.device.allocate_memory(&info, None) }.map_err(failed("vkAllocateMemory"))?;
        let mut mapped = None;
        if is_mapped {
            // SAFETY: the memory was just made.
            let at = unsafe { self.device.map_memory(memory, 0, vk::WHOLE_SIZE, vk::MemoryMapFlags::empty()) };
            mapped = NonNull::new(at.map_err(failed("vkMapMemory"))?.cast());
        }
        let mut state = self.state.lock().unwrap();
        state.pools.insert(request.pool.name());
        state.living.insert(memory.as_raw(), needs.size);
        Ok(Allocation { memory, offset: 0, size: needs.size, mapped, key: memory.as_raw() })
    }

    unsafe fn free(&self, allocation: Allocation) {
        self.state.lock().unwrap().living.remove(&allocation.key).expect("freed once");
        // SAFETY: nothing is bound to it.
        unsafe { self.device.free_memory(allocation.memory, None) }
    }

    fn report(&self) -> MemoryReport {
        let bytes = self.state.lock().unwrap().living.values().sum();
        MemoryReport { taken: bytes, used: bytes }
    }
}

#[test]
fn every_allocator_serves_the_same_picture() {
    let host = Host::new();
    let targets = Targets::new(&host, SIZE, FORMAT);
    let drawn = |lent: HostDevice| {
        let mut renderer = renderer_on(lent, &shapes::sphere(), FORMAT);
        draw(&host, &mut renderer, &targets, &camera(), None);
        let MemoryReport { taken, used } = renderer.memory_report();
        let of_objects: u64 = renderer.report(0).unwrap().unwrap().stats.pools.iter().map(|pool| pool.bytes).sum();
        assert!(of_objects > 0 && used >= of_objects && taken >= used, "{taken} taken, {used} used, {of_objects}");
        let (colour, depth) = targets.values();
        (colour, depth.into_iter().map(f32::to_bits).collect::<Vec<_>>())
    };
    let expected = drawn(host.lend());
    assert!(expected.0.iter().filter(|c| **c != [0, 0, 255, 255]).count() > 1500, "few pixels show the sphere");
    // SAFETY: the handles are those of the host, which lives longer than its renderers.
    let by_handles = unsafe { HostDevice::from_raw(host.raw()) };
    assert!(by_handles.device.handle() == host.device.handle() && !by_handles.debug_names);
    assert!(drawn(by_handles) == expected, "another picture by handles");
    // SAFETY: the physical device is that of the instance.
    let memory = unsafe { host.instance.get_physical_device_memory_properties(host.lend().physical) };
    let plain = Arc::new(Plain { device: host.device.clone(), memory, state: Mutex::default() });
    let own = HostDevice { allocator: plain.clone(), ..host.lend() };
    assert!(drawn(own) == expected, "another picture with the host's allocator");
    let state = plain.state.lock().unwrap();
    assert!(state.living.is_empty(), "{:?} were not freed", state.living);
    assert_eq!(state.pools, BTreeSet::from(Pool::ALL.map(Pool::name)), "each pool asks");
    targets.destroy(&host);
    assert_eq!(host.shutdown(), [""; 0]);
}

#[test]
#[should_panic(expected = "the device is a null handle")]
fn a_null_handle_is_refused() {
    let host = Host::new();
    // SAFETY: it panics before it uses a handle.
    let _ = unsafe { HostDevice::from_raw(selvedge::gpu::RawDevice { device: 0, ..host.raw() }) };
}

/// A request takes nothing from the device where it has room in a block of a gpu-allocator.
#[test]
fn a_shared_allocator_tells_what_fits() {
    const MIB: u64 = 1 << 20;
    let host = Host::new();
    let allocator = host.lend().allocator;
    let request = |size, location| MemoryRequest {
        name: "one",
        pool: Pool::Transient,
        requirements: vk::MemoryRequirements { size, alignment: 256, memory_type_bits: u32::MAX },
        location,
        linear: true,
        left: u64::MAX,
    };
    let (small, upload) = (request(MIB, MemoryLocation::Device), request(MIB, MemoryLocation::Upload));
    assert!(!allocator.fits(&small), "nothing was taken yet");
    let first = allocator.allocate(&small).unwrap();
    let before = allocator.report();
    assert!(allocator.fits(&small) && !allocator.fits(&upload), "no piece for uploads tells the memory type");
    assert!(!allocator.fits(&request(before.taken, MemoryLocation::Device)), "the block is not empty");
    let second = allocator.allocate(&small).unwrap();
    let after = allocator.report();
    assert_eq!((after.taken, after.used), (before.taken, before.used + MIB));
    // SAFETY: nothing is bound to them.
    [first, second].into_iter().for_each(|piece| unsafe { allocator.free(piece) });
    assert_eq!(allocator.report().used, 0);
    drop(allocator);
    assert_eq!(host.shutdown(), [""; 0]);
}
