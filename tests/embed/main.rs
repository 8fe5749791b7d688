//! The renderer in another engine: a host with its own instance, device, allocator, images, command buffers, fences and
//! barriers, without `selvedge::headless`.
//!
//! Needs a Vulkan driver and the validation layers, like the other tests on a device.

mod allocators;
mod flight;
mod host;
mod picture;
#[path = "../shapes/mod.rs"]
mod shapes;
mod targets;
