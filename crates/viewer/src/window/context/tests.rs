//! Makes the device of a window, and what draws on it, while one call of Vulkan fails: each call in turn.

#[allow(dead_code)] // the engine's tests use more of it
#[path = "../../../../../tests/faults/driver.rs"]
mod driver;

use super::*;
use crate::window::composite::Composite;
use crate::window::swapchain::Swapchain;
use crate::window::targets::{PickBuffer, Targets};
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

/// Width and height of the window.
const WINDOW: (u32, u32) = (40, 30);

/// What draws on a device, made and destroyed.
type Part = fn(&Context) -> Result<(), ViewError>;

const PARTS: [(&str, Part); 4] = [
    ("the composite pass", |context| {
        Composite::new(context, vk::Format::B8G8R8A8_SRGB)?.destroy(context);
        Ok(())
    }),
    ("the images of a picture", |context| {
        Targets::new(context, WINDOW)?.destroy(context);
        Ok(())
    }),
    ("the buffer of a pick", |context| {
        PickBuffer::new(context)?.destroy(context);
        Ok(())
    }),
    ("a swapchain, and the next one", |context| {
        let old = Swapchain::new(context, WINDOW, None)?;
        let new = Swapchain::new(context, WINDOW, old)?;
        assert!(new.as_ref().is_some_and(|new| new.size == WINDOW && new.images.len() == 2 && new.drawn.len() == 2));
        new.into_iter().for_each(|new| new.destroy(context));
        Ok(())
    }),
];

/// A context on the null driver.
fn opened(driver: &Driver) -> Context {
    driver.plan(None);
    driver.set_window(WINDOW);
    let surface = |_: &ash::Entry, _: &ash::Instance| Ok(vk::SurfaceKHR::from_raw(7));
    // SAFETY: the null driver looks at no surface.
    let opened = unsafe { Context::of_surface(driver.entry(), Vec::new(), &DeviceOptions::default(), surface) };
    opened.unwrap_or_else(|error| panic!("{error}"))
}

/// Objects that live, and pieces of the allocator's memory.
fn left(driver: &Driver, context: &Context) -> (Vec<&'static str>, usize) {
    let allocator = context.allocator().lock().unwrap_or_else(PoisonError::into_inner);
    (driver.living(), allocator.generate_report().allocations.len())
}

/// The first run makes the allocator's blocks, which stay: the calls that fail are those of the second one.
#[test]
fn a_failed_part_of_a_window_leaves_nothing() {
    let driver = Driver::new(true);
    let context = opened(&driver);
    for (what, part) in PARTS {
        part(&context).unwrap_or_else(|error| panic!("{what}: {error}"));
        let before = left(&driver, &context);
        assert_eq!(before.1, 0, "{what}");
        driver.plan(None);
        part(&context).unwrap_or_else(|error| panic!("{what}: {error}"));
        let calls = driver.calls();
        assert!(calls.values().sum::<u32>() > 1, "{what}: {calls:?}");
        for (call, count) in calls {
            for nth in 0..count {
                let fault = Fault { call, nth, result: vk::Result::ERROR_OUT_OF_HOST_MEMORY };
                driver.plan(Some(fault));
                let failed = part(&context);
                let is_it = matches!(failed, Err(ViewError::Vulkan(vk::Result::ERROR_OUT_OF_HOST_MEMORY)));
                assert!(is_it && driver.injected() == 1, "{what}, {fault:?}: {failed:?}");
                assert_eq!(left(&driver, &context), before, "{what}, {fault:?}");
            }
        }
    }
    driver.plan(None);
    context.shutdown();
    assert!(driver.living().is_empty(), "{:?}", driver.living());
}

/// As of a minimised window: its images go, and there are no others.
#[test]
fn a_window_without_a_size_has_no_images() {
    let driver = Driver::new(true);
    let context = opened(&driver);
    let before = driver.living();
    let some = Swapchain::new(&context, WINDOW, None).expect("made");
    assert!(some.is_some() && driver.living().len() > before.len());
    driver.set_window((0, 0));
    let none = Swapchain::new(&context, WINDOW, some).expect("a window may have no size");
    assert!(none.is_none());
    assert_eq!(driver.living(), before);
    context.shutdown();
}
