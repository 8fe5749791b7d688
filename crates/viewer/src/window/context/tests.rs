//! A driver of which each call that opens a device fails in turn.

#[allow(dead_code)] // the engine's tests use more of it
#[path = "../../../../../tests/faults/driver.rs"]
mod driver;

use super::*;
use driver::{Driver, Fault};
use selvedge::ash::vk::Handle;
use std::cell::Cell;

/// Whatever fails, the instance, the surface, the device and its objects are destroyed, each once.
#[test]
fn a_failed_opening_leaves_nothing() {
    let driver = Driver::new(true);
    let surfaces = Cell::new(0);
    let open = || {
        let surface = |_: &ash::Entry, _: &ash::Instance| {
            surfaces.set(surfaces.get() + 1);
            Ok(vk::SurfaceKHR::from_raw(7))
        };
        // SAFETY: the null driver looks at no surface.
        unsafe { Context::of_surface(driver.entry(), Vec::new(), &DeviceOptions::default(), surface) }
    };
    let is_clean = |what: &str| {
        assert!(driver.living().is_empty(), "{what} leaks {:?}", driver.living());
        assert_eq!(
            (driver.instances(), driver.surfaces_destroyed()),
            (0, surfaces.get()),
            "{what}: instances, surfaces"
        );
    };
    driver.plan(None);
    open().unwrap_or_else(|error| panic!("{error}")).shutdown();
    is_clean("an opened window");
    let calls = driver.calls();
    for name in ["vkCreateInstance", "vkCreateDevice", "vkCreateCommandPool", "vkCreateFence", "vkCreateSemaphore"] {
        assert_eq!(calls.get(name), Some(&1), "{calls:?}");
    }
    for (call, count) in calls {
        for nth in 0..count {
            let fault = Fault { call, nth, result: vk::Result::ERROR_OUT_OF_HOST_MEMORY };
            driver.plan(Some(fault));
            assert!(matches!(open(), Err(ViewError::Vulkan(vk::Result::ERROR_OUT_OF_HOST_MEMORY))), "{fault:?}");
            assert_eq!(driver.injected(), 1, "{fault:?}");
            is_clean(&format!("{fault:?}"));
        }
    }
    assert!(surfaces.get() > 4, "most calls fail behind the surface");
}
