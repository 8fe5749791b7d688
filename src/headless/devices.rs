//! The system's Vulkan devices: their properties, and the requirements that each does not meet.

use super::instance::{Instance, rank};
use super::{HeadlessError, HeadlessOptions, loader};
use crate::gpu::{Named, Quirks, Requirements, text};
use ash::vk;

/// A device, as it describes itself.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct DeviceSummary {
    /// Its name.
    pub name: String,
    /// `discrete`, `integrated`, `virtual`, `CPU` or `other`.
    pub kind: &'static str,
    /// The driver's name and version.
    pub driver: String,
    /// The version of Vulkan that it supports.
    pub vulkan: String,
    /// Requirements that it does not meet: [`Requirements::missing`]. If empty, the engine runs on it.
    pub missing: Vec<String>,
    /// The engine takes it if the user names no device.
    pub is_default: bool,
    /// Its limits.
    pub limits: DeviceLimits,
}

/// Limits that bound pictures and models.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize))]
#[non_exhaustive]
pub struct DeviceLimits {
    /// Bytes of all heaps of device memory.
    pub device_memory_bytes: u64,
    /// Bytes of the largest list that a shader writes (`maxStorageBufferRange`).
    pub storage_buffer_bytes: u64,
    /// Bytes of the largest list that is read as texels of sixteen bytes: 16 times `maxTexelBufferElements`.
    pub texel_buffer_bytes: u64,
    /// Width and height of the largest picture, pixels.
    pub picture_px: u32,
    /// Segments of a side of a sub-patch (`maxTessellationGenerationLevel`).
    pub tessellation_level: u32,
    /// Vertices of one tessellated draw; `None`: no bound.
    pub tessellated_vertices: Option<u32>,
    /// Workgroups of one dispatch along x.
    pub workgroups: u32,
    /// Fewest and most invocations of a subgroup; the engine runs with any.
    pub subgroup_sizes: [u32; 2],
    /// The driver counts triangles.
    pub counts_triangles: bool,
    /// The GPU measures the time of a pass.
    pub has_timestamps: bool,
    /// The driver reports how much memory is left (`VK_EXT_memory_budget`).
    pub tells_budget: bool,
}

/// All Vulkan devices of the system, whether or not the engine runs on them.
///
/// # Errors
/// [`HeadlessError::NoLoader`], [`HeadlessError::NoDevice`], [`HeadlessError::Gpu`].
pub fn devices() -> Result<Vec<DeviceSummary>, HeadlessError> {
    let instance = Instance::new(loader::load()?, &HeadlessOptions::default())?;
    // SAFETY: the instance is alive.
    let all = unsafe { instance.raw.enumerate_physical_devices() }.named("vkEnumeratePhysicalDevices", "instance")?;
    if all.is_empty() {
        return Err(HeadlessError::NoDevice);
    }
    let chosen = instance.choose(None).ok();
    let mut summaries: Vec<_> = all.into_iter().map(|physical| of(&instance, physical, chosen)).collect();
    summaries.sort_by_key(|(rank, _)| *rank);
    Ok(summaries.into_iter().map(|(_, summary)| summary).collect())
}

fn of(instance: &Instance, physical: vk::PhysicalDevice, chosen: Option<vk::PhysicalDevice>) -> (u32, DeviceSummary) {
    let raw = &instance.raw;
    let mut driver = vk::PhysicalDeviceDriverProperties::default();
    let mut subgroups = vk::PhysicalDeviceSubgroupSizeControlProperties::default();
    let mut subgroup = vk::PhysicalDeviceSubgroupProperties::default();
    // SAFETY: the device belongs to this instance, which was made for Vulkan 1.3.
    let (plain, memory, features, extensions, missing) = unsafe {
        (
            raw.get_physical_device_properties(physical),
            raw.get_physical_device_memory_properties(physical),
            raw.get_physical_device_features(physical),
            raw.enumerate_device_extension_properties(physical).unwrap_or_default(),
            Requirements::missing(raw, physical),
        )
    };
    // older devices do not have these structs
    if plain.api_version >= Requirements::API_VERSION {
        let mut all = vk::PhysicalDeviceProperties2::default()
            .push_next(&mut driver)
            .push_next(&mut subgroups)
            .push_next(&mut subgroup);
        // SAFETY: as above; structs of Vulkan 1.3.
        unsafe { raw.get_physical_device_properties2(physical, &mut all) };
    }
    let limits = &plain.limits;
    let local = |heap: &&vk::MemoryHeap| heap.flags.contains(vk::MemoryHeapFlags::DEVICE_LOCAL);
    let vertices = Quirks::of(driver.driver_id).max_tessellated_vertices_per_draw;
    let sizes = match [subgroups.min_subgroup_size, subgroups.max_subgroup_size] {
        [0, _] => [subgroup.subgroup_size; 2],
        sizes => sizes,
    };
    let (major, minor) = (vk::api_version_major(plain.api_version), vk::api_version_minor(plain.api_version));
    let summary = DeviceSummary {
        name: text(&plain.device_name),
        kind: match plain.device_type {
            vk::PhysicalDeviceType::DISCRETE_GPU => "discrete",
            vk::PhysicalDeviceType::INTEGRATED_GPU => "integrated",
            vk::PhysicalDeviceType::VIRTUAL_GPU => "virtual",
            vk::PhysicalDeviceType::CPU => "CPU",
            _ => "other",
        },
        driver: format!("{} {}", text(&driver.driver_name), text(&driver.driver_info)).trim().to_owned(),
        vulkan: format!("{major}.{minor}.{}", vk::api_version_patch(plain.api_version)),
        missing,
        is_default: chosen == Some(physical),
        limits: DeviceLimits {
            device_memory_bytes: memory.memory_heaps_as_slice().iter().filter(local).map(|heap| heap.size).sum(),
            storage_buffer_bytes: limits.max_storage_buffer_range.into(),
            texel_buffer_bytes: 16 * u64::from(limits.max_texel_buffer_elements),
            picture_px: limits
                .max_image_dimension2_d
                .min(limits.max_framebuffer_width)
                .min(limits.max_framebuffer_height),
            tessellation_level: limits.max_tessellation_generation_level,
            tessellated_vertices: (vertices < u32::MAX).then_some(vertices),
            workgroups: limits.max_compute_work_group_count[0],
            subgroup_sizes: sizes,
            counts_triangles: features.pipeline_statistics_query == vk::TRUE,
            has_timestamps: limits.timestamp_compute_and_graphics == vk::TRUE,
            tells_budget: extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(ash::ext::memory_budget::NAME)),
        },
    };
    (rank(plain.device_type), summary)
}

/// The missing requirements in words.
pub(super) fn lacks(missing: &[String]) -> String {
    let list = missing.join(", ");
    if missing.iter().any(|what| what == "feature tessellation_shader") {
        format!("{list} (surfaces are drawn by hardware tessellation, which portability drivers often do not have)")
    } else {
        list
    }
}

impl DeviceSummary {
    /// Its missing requirements in words; `None`: it meets all.
    pub fn lacks(&self) -> Option<String> {
        (!self.missing.is_empty()).then(|| lacks(&self.missing))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn missing_tessellation_is_explained_in_one_sentence() {
        let words = |what: &[&str]| lacks(&what.iter().map(|w| (*w).to_owned()).collect::<Vec<_>>());
        assert_eq!(words(&["feature maintenance4"]), "feature maintenance4");
        let both = words(&["feature tessellation_shader", "feature maintenance4"]);
        assert!(both.starts_with("feature tessellation_shader, feature maintenance4 (surfaces are drawn by"), "{both}");
    }

    /// The tests run on a device: it is listed, one is the default, and its limits are those that the renderer sees.
    #[test]
    fn the_default_device_is_the_one_that_is_taken() {
        let all = devices().unwrap();
        let default: Vec<_> = all.iter().filter(|device| device.is_default).collect();
        assert_eq!(default.len(), 1, "{all:?}");
        let device = super::super::HeadlessDevice::new(&HeadlessOptions::default()).unwrap();
        let (taken, summary) = (device.device(), default[0]);
        assert_eq!((taken.name(), taken.driver()), (summary.name.as_str(), summary.driver.as_str()));
        assert_eq!(u64::from(taken.limits().max_storage_buffer_range), summary.limits.storage_buffer_bytes);
        assert!(summary.lacks().is_none() && summary.limits.subgroup_sizes[0] >= 1, "{summary:?}");
    }
}
