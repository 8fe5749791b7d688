//! A driver that fails: each call that may return an error does so once. `driver` is a double of the Vulkan driver.
//!
//! The null driver draws nothing, which makes runs fast enough to fail each call of a script in turn. Pictures after a
//! failure are compared on the system's driver.

mod budget;
mod driver;
mod host;
mod memory;
mod pictures;
mod script;
#[path = "../shapes/mod.rs"]
mod shapes;
