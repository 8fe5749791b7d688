//! Selvedge draws trimmed spline surfaces exactly, at the resolution of the picture.
//!
//! Start at [`model`] for what is drawn and `ARCHITECTURE.md` for how.
#![warn(missing_docs)]

/// Vulkan's bindings, the allocator and the vectors, in the versions that this crate's types take.
pub use {ash, glam, gpu_allocator};

/// What is drawn, and what makes it: `selvedge-geometry`.
pub use selvedge_geometry::{construct, csg, edges, math, model, spline, trim};

/// Shared test shapes name the library as its users do.
#[cfg(test)]
extern crate self as selvedge;

/// For tests: what passes read and write.
#[doc(hidden)]
pub mod abi;
/// Other ways to trim and to divide, for comparisons: no part of what a host uses.
#[cfg(feature = "baselines")]
#[doc(hidden)]
pub mod baselines;
mod bindings;
mod budget;
#[cfg(any(test, feature = "baselines"))]
mod fixtures;
mod frame;
pub mod gpu;
#[cfg(feature = "headless")]
pub mod headless;
#[cfg(test)]
mod parity;
/// For tests of the Vulkan layer.
#[doc(hidden)]
pub mod passes {
    pub use crate::frame::common::scan;
}
pub mod picture;
pub mod renderer;
mod scene;
mod shaders;
/// For tests: what passes compute, on the CPU.
#[doc(hidden)]
pub mod twin;

/// The examples of the README compile.
#[cfg(all(doctest, feature = "headless"))]
#[doc = include_str!("../README.md")]
struct Readme;
