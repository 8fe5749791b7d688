//! The double's functions of instances and physical devices.

use super::{Callbacks, call, real, with};
use ash::vk;
use std::ffi::{c_char, c_void};
use std::mem::transmute;

pub unsafe extern "system" fn create_instance(info: *const c_void, none: Callbacks, made: *mut u64) -> vk::Result {
    type Create = unsafe extern "system" fn(*const c_void, Callbacks, *mut u64) -> vk::Result;
    let original = real("vkCreateInstance").expect("asked for before");
    let result = call("vkCreateInstance", || {
        if let Some(instance) = with(|state| state.instance) {
            // SAFETY: room for the handle.
            unsafe { *made = instance };
            return vk::Result::SUCCESS;
        }
        // SAFETY: as Vulkan's rules for the call promise.
        let result = unsafe { transmute::<usize, Create>(original)(info, none, made) };
        if result == vk::Result::SUCCESS && with(|state| state.null) {
            // SAFETY: the call wrote it.
            let instance = unsafe { *made };
            with(|state| state.instance = Some(instance));
        }
        result
    });
    with(|state| state.instances += i32::from(result == vk::Result::SUCCESS));
    result
}

pub unsafe extern "system" fn destroy_instance(instance: vk::Instance, none: Callbacks) {
    let is_kept = with(|state| {
        state.instances -= 1;
        state.instance.is_some()
    });
    if let Some(real) = real("vkDestroyInstance").filter(|_| !is_kept) {
        // SAFETY: as Vulkan's rules for the call promise.
        unsafe { transmute::<usize, vk::PFN_vkDestroyInstance>(real)(instance, none.cast()) }
    }
}

/// Every device presents to every surface.
pub unsafe extern "system" fn presents(_: vk::PhysicalDevice, _: u32, _: u64, answer: *mut vk::Bool32) -> vk::Result {
    // SAFETY: room for the answer.
    unsafe { *answer = vk::TRUE };
    vk::Result::SUCCESS
}

pub unsafe extern "system" fn destroy_surface(_: vk::Instance, _: u64, _: Callbacks) {
    with(|state| state.surfaces_destroyed += 1);
}

/// At least one image, and as many as wanted.
pub unsafe extern "system" fn surface_capabilities(
    _: vk::PhysicalDevice,
    _: u64,
    answer: *mut vk::SurfaceCapabilitiesKHR,
) -> vk::Result {
    call("vkGetPhysicalDeviceSurfaceCapabilitiesKHR", || {
        let (width, height) = with(|state| state.window);
        let current_extent = vk::Extent2D { width, height };
        // SAFETY: room for the answer.
        unsafe { *answer = vk::SurfaceCapabilitiesKHR { min_image_count: 1, current_extent, ..Default::default() } };
        vk::Result::SUCCESS
    })
}

/// One format.
pub unsafe extern "system" fn surface_formats(
    _: vk::PhysicalDevice,
    _: u64,
    count: *mut u32,
    all: *mut vk::SurfaceFormatKHR,
) -> vk::Result {
    call("vkGetPhysicalDeviceSurfaceFormatsKHR", || {
        let color_space = vk::ColorSpaceKHR::SRGB_NONLINEAR;
        // SAFETY: room for the number, and for one format where there is an array.
        unsafe {
            *count = 1;
            if !all.is_null() {
                all.write(vk::SurfaceFormatKHR { format: vk::Format::B8G8R8A8_SRGB, color_space });
            }
        }
        vk::Result::SUCCESS
    })
}

/// The driver's extensions, and the one that tells the budget.
pub unsafe extern "system" fn extensions(
    physical: vk::PhysicalDevice,
    layer: *const c_char,
    count: *mut u32,
    all: *mut vk::ExtensionProperties,
) -> vk::Result {
    let original = real("vkEnumerateDeviceExtensionProperties").expect("asked for before");
    // SAFETY: the driver's function; room for its answer, and for one more where there is an array.
    unsafe {
        let original = transmute::<usize, vk::PFN_vkEnumerateDeviceExtensionProperties>(original);
        if with(|state| state.full.is_none()) {
            return original(physical, layer, count, all);
        }
        if all.is_null() {
            let result = original(physical, layer, count, all);
            *count += 1;
            return result;
        }
        *count -= 1;
        let result = original(physical, layer, count, all);
        let mut added = vk::ExtensionProperties::default();
        let name = ash::ext::memory_budget::NAME.to_bytes_with_nul();
        added.extension_name.iter_mut().zip(name).for_each(|(to, byte)| *to = *byte as c_char);
        all.add(*count as usize).write(added);
        *count += 1;
        result
    }
}

pub unsafe extern "system" fn memory_properties(
    physical: vk::PhysicalDevice,
    properties: *mut vk::PhysicalDeviceMemoryProperties2<'_>,
) {
    let original = real("vkGetPhysicalDeviceMemoryProperties2").expect("asked for before");
    // SAFETY: the driver's function, and the structs of the caller's chain.
    unsafe {
        transmute::<usize, vk::PFN_vkGetPhysicalDeviceMemoryProperties2>(original)(physical, properties);
        let Some(full) = with(|state| state.full) else { return };
        let heaps = (*properties).memory_properties.memory_heaps;
        let mut next = (*properties).p_next.cast::<vk::BaseOutStructure<'_>>();
        while !next.is_null() {
            if (*next).s_type == vk::StructureType::PHYSICAL_DEVICE_MEMORY_BUDGET_PROPERTIES_EXT {
                let budget = next.cast::<vk::PhysicalDeviceMemoryBudgetPropertiesEXT<'_>>();
                (*budget).heap_budget = heaps.map(|heap| heap.size);
                (*budget).heap_usage = heaps.map(|heap| if full { heap.size } else { 0 });
            }
            next = (*next).p_next;
        }
    }
}
