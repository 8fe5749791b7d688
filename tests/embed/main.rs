//! The renderer in somebody else's engine: a host with its own instance, device, allocator, images,
//! command buffers, fences and barriers, which never sees `selvedge::headless`.
//!
//! Needs a Vulkan driver and the validation layers, as the other tests on a device do.

mod flight;
mod host;
mod picture;
#[path = "../shapes/mod.rs"]
mod shapes;
mod targets;
