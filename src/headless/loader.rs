//! The system's Vulkan loader. It keeps the driver loaded in a process that opens several devices.
//!
//! The loader unloads a driver's library with the last instance. NVIDIA's (580) takes static thread-local storage each
//! time that it is loaded, and does not give it back. After some tens of loads it "cannot allocate memory in static TLS
//! block", and the process finds no device any more. So the second call makes an instance that stays alive for as long
//! as the process, and the driver is loaded twice at most. A process that opens one device does without.

use super::HeadlessError;
use ash::vk;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

static CALLED: AtomicBool = AtomicBool::new(false);
/// Never destroyed; `None` where the loader could make none.
static KEPT: OnceLock<Option<(ash::Entry, ash::Instance)>> = OnceLock::new();

/// Loads the library.
///
/// # Errors
/// [`HeadlessError::NoLoader`].
pub(super) fn load() -> Result<ash::Entry, HeadlessError> {
    // SAFETY: the system's Vulkan loader is trusted as any shared library of the system is.
    let entry = unsafe { ash::Entry::load() }.map_err(|source| HeadlessError::NoLoader { source })?;
    if CALLED.swap(true, Ordering::Relaxed) {
        KEPT.get_or_init(|| {
            // SAFETY: the entry is loaded, and stays so beside its instance.
            let instance = unsafe { entry.create_instance(&vk::InstanceCreateInfo::default(), None) };
            Some((entry.clone(), instance.ok()?))
        });
    }
    Ok(entry)
}
