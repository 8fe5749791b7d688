//! Selvedge draws trimmed spline surfaces exactly, at the resolution of the picture.
//!
//! Start at [`model`] for what is drawn and `ARCHITECTURE.md` for how.
#![warn(missing_docs)]

/// Vulkan's bindings and the allocator, in the versions that [`gpu::HostDevice`] takes.
pub use {ash, gpu_allocator};

/// Shared test shapes name the library as its users do.
#[cfg(test)]
extern crate self as selvedge;

pub mod abi;
mod bindings;
pub mod brep;
mod budget;
mod buffers;
mod capacities;
pub mod construct;
pub mod csg;
pub mod export;
mod frame;
pub mod gpu;
#[cfg(feature = "headless")]
pub mod headless;
pub mod import;
pub mod math;
pub mod model;
#[cfg(test)]
mod parity;
pub mod passes;
pub mod picture;
pub mod reference;
pub mod renderer;
#[cfg(feature = "rivals")]
pub mod rivals;
mod scene;
mod shaders;
pub mod spline;
#[cfg(any(test, feature = "rivals"))]
mod trial;
pub mod trim;
pub mod twin;

/// The examples of the README compile.
#[cfg(all(doctest, feature = "headless"))]
#[doc = include_str!("../README.md")]
struct Readme;
