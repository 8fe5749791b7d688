//! The requirements on a Vulkan device, for a host with its own device.
//!
//! ```no_run
//! # use ash::vk; use selvedge::gpu::Requirements;
//! # fn f(instance: &ash::Instance, physical: vk::PhysicalDevice) {
//! // SAFETY: the physical device belongs to the instance.
//! let missing = unsafe { Requirements::missing(instance, physical) };
//! assert!(missing.is_empty(), "this device lacks {}", missing.join(", "));
//!
//! let (mut core, mut v12, mut v13) = Default::default();      // the host's own wishes stand here
//! Requirements::add_to(&mut core, &mut v12, &mut v13);
//! let device_info = vk::DeviceCreateInfo::default()
//!     .enabled_features(&core)
//!     .push_next(&mut v12)
//!     .push_next(&mut v13);
//! # }
//! ```

use ash::vk;
use std::ffi::CStr;

/// The engine's requirements on a device, stated only in the table below.
pub struct Requirements;

/// Writes the query and the merge from one list of features per Vulkan version.
macro_rules! required_features {
    ($(core $core:ident,)* $(v12 $v12:ident,)* $(v13 $v13:ident,)*) => {
        /// Sets every required bit and leaves the others as the host set them.
        pub fn add_to(
            core: &mut vk::PhysicalDeviceFeatures,
            v12: &mut vk::PhysicalDeviceVulkan12Features<'_>,
            v13: &mut vk::PhysicalDeviceVulkan13Features<'_>,
        ) {
            $(core.$core = vk::TRUE;)*
            $(v12.$v12 = vk::TRUE;)*
            $(v13.$v13 = vk::TRUE;)*
        }

        fn missing_features(
            core: &vk::PhysicalDeviceFeatures,
            v12: &vk::PhysicalDeviceVulkan12Features<'_>,
            v13: &vk::PhysicalDeviceVulkan13Features<'_>,
        ) -> Vec<String> {
            let mut names = Vec::new();
            $(if core.$core == vk::FALSE { names.push(concat!("feature ", stringify!($core)).to_owned()); })*
            $(if v12.$v12 == vk::FALSE { names.push(concat!("feature ", stringify!($v12)).to_owned()); })*
            $(if v13.$v13 == vk::FALSE { names.push(concat!("feature ", stringify!($v13)).to_owned()); })*
            names
        }
    };
}

impl Requirements {
    /// The oldest Vulkan version, for the instance (`apiVersion`) and the device.
    pub const API_VERSION: u32 = vk::API_VERSION_1_3;

    /// Device extensions to enable.
    pub const DEVICE_EXTENSIONS: &[&CStr] = &[ash::khr::push_descriptor::NAME];

    /// Capabilities of the one queue family that the command buffers belong to.
    pub const QUEUE_FLAGS: vk::QueueFlags =
        vk::QueueFlags::from_raw(vk::QueueFlags::GRAPHICS.as_raw() | vk::QueueFlags::COMPUTE.as_raw());

    required_features! {
        core tessellation_shader,
        core multi_draw_indirect,
        core independent_blend,
        core fragment_stores_and_atomics,
        v12 draw_indirect_count,
        v12 scalar_block_layout,
        v13 synchronization2,
        v13 dynamic_rendering,
        // SPIR-V 1.6 states a workgroup's size by LocalSizeId, which this feature allows.
        v13 maintenance4,
    }

    /// Names of the features that `physical` lacks; empty if the engine runs on it.
    ///
    /// # Safety
    /// `physical` belongs to `instance`, and `instance` was made for Vulkan 1.1 or later.
    pub unsafe fn missing(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Vec<String> {
        // SAFETY: as the caller promises.
        let properties = unsafe { instance.get_physical_device_properties(physical) };
        if properties.api_version < Self::API_VERSION {
            let (major, minor) =
                (vk::api_version_major(properties.api_version), vk::api_version_minor(properties.api_version));
            // An older device does not have the feature structs below.
            return vec![format!("Vulkan 1.3 (it offers {major}.{minor})")];
        }
        let mut v12 = vk::PhysicalDeviceVulkan12Features::default();
        let mut v13 = vk::PhysicalDeviceVulkan13Features::default();
        let mut all = vk::PhysicalDeviceFeatures2::default().push_next(&mut v12).push_next(&mut v13);
        // SAFETY: as the caller promises; the chain holds structs of Vulkan 1.3 only.
        unsafe { instance.get_physical_device_features2(physical, &mut all) };
        let core = all.features;
        let mut names = Self::missing_features(&core, &v12, &v13);
        // SAFETY: as the caller promises.
        match unsafe { instance.enumerate_device_extension_properties(physical) } {
            Ok(extensions) => {
                let has = |wanted: &CStr| extensions.iter().any(|e| e.extension_name_as_c_str() == Ok(wanted));
                let lacking = Self::DEVICE_EXTENSIONS.iter().filter(|wanted| !has(wanted));
                names.extend(lacking.map(|wanted| format!("extension {}", wanted.to_string_lossy())));
            }
            Err(error) => {
                names.push(format!("a list of its extensions (vkEnumerateDeviceExtensionProperties: {error})"))
            }
        }
        // SAFETY: as the caller promises.
        if unsafe { Self::queue_family(instance, physical) }.is_none() {
            names.push("a queue family for graphics and compute".to_owned());
        }
        names
    }

    /// The first queue family with [`QUEUE_FLAGS`](Self::QUEUE_FLAGS).
    ///
    /// # Safety
    /// `physical` belongs to `instance`.
    pub unsafe fn queue_family(instance: &ash::Instance, physical: vk::PhysicalDevice) -> Option<u32> {
        // SAFETY: as the caller promises.
        let families = unsafe { instance.get_physical_device_queue_family_properties(physical) };
        families.iter().position(|f| f.queue_flags.contains(Self::QUEUE_FLAGS)).map(|i| i as u32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_empty_device_lacks_every_feature_and_a_merged_one_lacks_none() {
        let (mut core, mut v12, mut v13) = Default::default();
        let missing = Requirements::missing_features(&core, &v12, &v13);
        assert!(missing.iter().any(|m| m == "feature tessellation_shader"));
        assert!(missing.iter().any(|m| m == "feature dynamic_rendering"));
        Requirements::add_to(&mut core, &mut v12, &mut v13);
        assert!(Requirements::missing_features(&core, &v12, &v13).is_empty());
    }

    #[test]
    fn merging_leaves_the_host_s_own_features() {
        let (mut core, mut v12, mut v13): (vk::PhysicalDeviceFeatures, _, _) = Default::default();
        core.wide_lines = vk::TRUE;
        Requirements::add_to(&mut core, &mut v12, &mut v13);
        assert_eq!(core.wide_lines, vk::TRUE);
        assert_eq!(core.geometry_shader, vk::FALSE);
    }
}
