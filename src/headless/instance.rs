//! Loader, instance, layers, and the choice of a device.

use super::devices::lacks;
use super::messages::Messages;
use super::{HeadlessError, HeadlessOptions};
use crate::gpu::{Named, Requirements};
use ash::vk;
use std::ffi::CStr;

const VALIDATION_LAYER: &CStr = c"VK_LAYER_KHRONOS_validation";

/// An instance of our own; destroyed on drop, after everything made from it.
pub(super) struct Instance {
    pub(super) raw: ash::Instance,
    pub(super) messages: Messages,
    pub(super) debug_utils: bool,
    messenger: Option<(ash::ext::debug_utils::Instance, vk::DebugUtilsMessengerEXT)>,
    // Last: the library stays loaded until the instance is gone.
    _entry: ash::Entry,
}

impl Instance {
    pub(super) fn new(entry: ash::Entry, options: &HeadlessOptions) -> Result<Self, HeadlessError> {
        let extensions = extensions_of(&entry, None);
        let debug_utils = extensions.iter().any(|name| name == ash::ext::debug_utils::NAME);
        let mut layers = Vec::new();
        let mut layer_settings = false;
        if options.validation {
            // SAFETY: the entry is loaded.
            let installed = unsafe { entry.enumerate_instance_layer_properties() }.unwrap_or_default();
            if !debug_utils || !installed.iter().any(|l| l.layer_name_as_c_str() == Ok(VALIDATION_LAYER)) {
                return Err(HeadlessError::NoValidation);
            }
            layers.push(VALIDATION_LAYER.as_ptr());
            let of_layer = extensions_of(&entry, Some(VALIDATION_LAYER));
            layer_settings = of_layer.iter().any(|name| name == ash::ext::layer_settings::NAME);
        }
        let mut enabled: Vec<_> = debug_utils.then_some(ash::ext::debug_utils::NAME.as_ptr()).into_iter().collect();

        // Newer layers read settings, and follow shader accesses only when a setting says so;
        // older ones know the validation features alone.
        let yes = vk::TRUE.to_ne_bytes();
        let settings = [c"validate_sync", c"syncval_shader_accesses_heuristic"].map(|name| {
            vk::LayerSettingEXT::default()
                .layer_name(VALIDATION_LAYER)
                .setting_name(name)
                .ty(vk::LayerSettingTypeEXT::BOOL32)
                .values(&yes)
        });
        // One BOOL32 each, where `values` counted bytes.
        let settings = settings.map(|mut setting| {
            setting.value_count = 1;
            setting
        });
        let mut settings = vk::LayerSettingsCreateInfoEXT::default().settings(&settings);
        let mut features = vk::ValidationFeaturesEXT::default()
            .enabled_validation_features(&[vk::ValidationFeatureEnableEXT::SYNCHRONIZATION_VALIDATION]);

        let messages = Messages::default();
        let mut early = messages.messenger();
        let app = vk::ApplicationInfo::default()
            .application_name(c"selvedge")
            .engine_name(c"selvedge")
            .api_version(Requirements::API_VERSION);
        if layer_settings {
            enabled.push(ash::ext::layer_settings::NAME.as_ptr());
        }
        // without it the loader lists no devices on top of another API
        let portability = extensions.iter().any(|name| name == ash::khr::portability_enumeration::NAME);
        let mut flags = vk::InstanceCreateFlags::empty();
        if portability {
            enabled.push(ash::khr::portability_enumeration::NAME.as_ptr());
            flags |= vk::InstanceCreateFlags::ENUMERATE_PORTABILITY_KHR;
        }
        let mut create = vk::InstanceCreateInfo::default()
            .flags(flags)
            .application_info(&app)
            .enabled_layer_names(&layers)
            .enabled_extension_names(&enabled);
        if options.validation {
            create = create.push_next(&mut early);
            create = if layer_settings { create.push_next(&mut settings) } else { create.push_next(&mut features) };
        }
        // SAFETY: everything that the chain points to outlives the call; `messages` outlives the instance.
        let raw = match unsafe { entry.create_instance(&create, None) } {
            // The loader found no driver at all.
            Err(vk::Result::ERROR_INCOMPATIBLE_DRIVER) => return Err(HeadlessError::NoDevice),
            made => made.named("vkCreateInstance", "instance")?,
        };
        let mut this = Self { raw, messages, debug_utils, messenger: None, _entry: entry };
        if options.validation {
            let debug = ash::ext::debug_utils::Instance::new(&this._entry, &this.raw);
            // SAFETY: `messages` lives in the same struct and outlives the messenger.
            let messenger = unsafe { debug.create_debug_utils_messenger(&this.messages.messenger(), None) }
                .named("vkCreateDebugUtilsMessengerEXT", "messenger")?;
            this.messenger = Some((debug, messenger));
        }
        Ok(this)
    }

    /// The device runs on top of another API.
    pub(super) fn is_portable(&self, physical: vk::PhysicalDevice) -> bool {
        // SAFETY: the device belongs to this instance.
        let all = unsafe { self.raw.enumerate_device_extension_properties(physical) }.unwrap_or_default();
        all.iter().any(|e| e.extension_name_as_c_str() == Ok(ash::khr::portability_subset::NAME))
    }

    /// The device that [`HeadlessOptions::device`] names.
    pub(super) fn choose(&self, wanted: Option<&str>) -> Result<vk::PhysicalDevice, HeadlessError> {
        // SAFETY: the instance is alive.
        let all = unsafe { self.raw.enumerate_physical_devices() }.named("vkEnumeratePhysicalDevices", "instance")?;
        let found = all.iter().map(|physical| {
            // SAFETY: the device belongs to this instance, which was made for Vulkan 1.3.
            let (properties, missing) = unsafe {
                (self.raw.get_physical_device_properties(*physical), Requirements::missing(&self.raw, *physical))
            };
            let name = properties.device_name_as_c_str().unwrap_or(c"?").to_string_lossy().into_owned();
            Found { name, rank: rank(properties.device_type), missing }
        });
        Ok(all[chosen(&found.collect::<Vec<_>>(), wanted)?])
    }
}

/// A device of the system.
struct Found {
    name: String,
    rank: u32,
    missing: Vec<String>,
}

/// The index of the device that [`HeadlessOptions::device`] names.
fn chosen(found: &[Found], wanted: Option<&str>) -> Result<usize, HeadlessError> {
    if found.is_empty() {
        return Err(HeadlessError::NoDevice);
    }
    let (name, nth) = wanted.map_or(("", 0), numbered);
    let name = name.to_lowercase();
    let (mut usable, lacking): (Vec<usize>, Vec<usize>) = (0..found.len())
        .filter(|k| found[*k].name.to_lowercase().contains(&name))
        .partition(|k| found[*k].missing.is_empty());
    usable.sort_by_key(|k| found[*k].rank);
    match (usable.get(nth), wanted) {
        (Some(k), _) => Ok(*k),
        (None, Some(wanted)) if !usable.is_empty() || lacking.is_empty() => {
            let names: Vec<&str> = found.iter().map(|device| device.name.as_str()).collect();
            Err(HeadlessError::NoSuchDevice { wanted: wanted.to_owned(), present: names.join(", ") })
        }
        _ => {
            let described = |k: &usize| format!("{} lacks {}", found[*k].name, lacks(&found[*k].missing));
            let devices: Vec<String> = lacking.iter().map(described).collect();
            Err(HeadlessError::Lacking { devices: devices.join("; ") })
        }
    }
}

/// `NAME#2` in parts; 0 without a number.
fn numbered(wanted: &str) -> (&str, usize) {
    let parts = wanted.rsplit_once('#').and_then(|(name, nth)| Some((name, nth.parse().ok()?)));
    parts.unwrap_or((wanted, 0))
}

impl Drop for Instance {
    fn drop(&mut self) {
        // SAFETY: what was made from the instance is gone: its owner declares it last.
        unsafe {
            if let Some((debug, messenger)) = &self.messenger {
                debug.destroy_debug_utils_messenger(*messenger, None);
            }
            self.raw.destroy_instance(None);
        }
    }
}

/// Names of the instance extensions that the loader, or a layer, offers.
fn extensions_of(entry: &ash::Entry, layer: Option<&CStr>) -> Vec<std::ffi::CString> {
    // SAFETY: the entry is loaded.
    let all = unsafe { entry.enumerate_instance_extension_properties(layer) }.unwrap_or_default();
    all.iter().filter_map(|e| e.extension_name_as_c_str().ok()).map(CStr::to_owned).collect()
}

/// Discrete before integrated before virtual before CPU.
pub(super) fn rank(kind: vk::PhysicalDeviceType) -> u32 {
    match kind {
        vk::PhysicalDeviceType::DISCRETE_GPU => 0,
        vk::PhysicalDeviceType::INTEGRATED_GPU => 1,
        vk::PhysicalDeviceType::VIRTUAL_GPU => 2,
        vk::PhysicalDeviceType::CPU => 3,
        _ => 4,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_device_is_chosen_by_name_and_number() {
        let of = |name: &str, rank, missing: &[&str]| Found {
            name: name.to_owned(),
            rank,
            missing: missing.iter().map(|what| (*what).to_owned()).collect(),
        };
        let found = [
            of("llvmpipe", 3, &[]),
            of("Titan A", 0, &[]),
            of("Old", 0, &["feature tessellation_shader"]),
            of("Titan B", 0, &[]),
            of("Iris", 1, &[]),
        ];
        let take = |wanted| chosen(&found, wanted).map_err(|error| error.to_string());
        for (wanted, expected) in [
            (None, 1),
            (Some("#0"), 1),
            (Some("#1"), 3),
            (Some("#2"), 4),
            (Some("#3"), 0),
            (Some("titan"), 1),
            (Some("TITAN#1"), 3),
            (Some("titan b"), 3),
            (Some("llvm#0"), 0),
        ] {
            assert_eq!(take(wanted), Ok(expected), "{wanted:?}");
        }
        for (wanted, told) in [
            ("#4", "named like `#4`; there are: llvmpipe, Titan A, Old, Titan B, Iris"),
            ("titan#2", "named like `titan#2`"),
            ("titan#", "named like `titan#`"),
            ("old", "Old lacks feature tessellation_shader"),
            ("old#0", "Old lacks"),
        ] {
            assert!(take(Some(wanted)).is_err_and(|error| error.contains(told)), "{wanted}");
        }
        assert!(matches!(chosen(&[], Some("#0")), Err(HeadlessError::NoDevice)));
    }
}
