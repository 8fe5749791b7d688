//! The Vulkan layer and its passes on a real driver, with the validation layers.
//!
//! Needs a Vulkan driver and the validation layers; on Debian: `apt install libvulkan1
//! mesa-vulkan-drivers vulkan-validationlayers`. Without them these tests fail and say so.

mod drawing;
mod lifetimes;
mod scan;
mod support;
mod synchronisation;
mod transition;
