//! Selvedge draws trimmed spline surfaces exactly, at the resolution of the picture.
//!
//! Start at [`model`] for what is drawn and `ARCHITECTURE.md` for how.
#![warn(missing_docs)]

/// Vulkan's bindings, the allocator and the vectors, in the versions that this crate's types take.
pub use {ash, glam, gpu_allocator};

/// What is drawn, and what makes it: `selvedge-geometry`.
pub use selvedge_geometry::{construct, csg, math, model, spline, trim};

/// Shared test shapes name the library as its users do.
#[cfg(test)]
extern crate self as selvedge;

pub mod abi;
mod bindings;
mod budget;
mod buffers;
mod capacities;
mod frame;
pub mod gpu;
#[cfg(feature = "headless")]
pub mod headless;
#[cfg(test)]
mod parity;
pub mod passes;
pub mod picture;
pub mod renderer;
#[cfg(feature = "rivals")]
pub mod rivals;
mod scene;
mod shaders;
#[cfg(any(test, feature = "rivals"))]
mod trial;
pub mod twin;

/// The examples of the README compile.
#[cfg(all(doctest, feature = "headless"))]
#[doc = include_str!("../README.md")]
struct Readme;
