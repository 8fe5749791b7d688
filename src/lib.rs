//! Selvedge draws trimmed spline surfaces and Boolean solids exactly, at the resolution of the picture, with raw Vulkan.
//!
//! | module | for |
//! |---|---|
//! | [`model`] | models: faces with trim loops, meshes, solids, instances, cameras |
//! | [`picture`] | settings of scenes and frames, images, statistics |
//! | [`renderer`] | hosts with a Vulkan device of their own: frames recorded into their command buffers |
//! | [`gpu`] | what such a host hands over, and what its device must offer |
//! | `headless` | pictures in memory, without a window |
//! | [`spline`], [`trim`], [`csg`], [`construct`] | surfaces, loops and solids by themselves, and constructions of them |
//!
//! | feature | gives |
//! |---|---|
//! | none | the renderer for hosts, from committed SPIR-V |
//! | `gpu-allocator` (default) | hosts share a gpu-allocator with the renderer |
//! | `headless` | an instance, a device and targets without a window |
//! | `serde` | settings and statistics as JSON |
//! | `compile-shaders` | shaders compiled from `glsl/` by shaderc |
//!
//! The crate `selvedge-io` reads files into models. With the feature `headless`, a model becomes a picture so:
//!
#![cfg_attr(feature = "headless", doc = "```no_run")]
#![cfg_attr(not(feature = "headless"), doc = "```ignore")]
//! use selvedge::headless::{HeadlessError, HeadlessOptions, HeadlessRenderer};
//! use selvedge::model::{Camera, Model};
//! use selvedge::{glam::DVec3, picture::*};
//!
//! fn draw(model: &Model) -> Result<Picture, HeadlessError> {
//!     let mut renderer = HeadlessRenderer::new(&HeadlessOptions::default())?;
//!     renderer.upload(model)?;
//!     let camera = Camera::framing(model, Camera::FROM, DVec3::Z, Camera::FOV_DEG.to_radians(), (1920, 1080));
//!     renderer.render(&camera, &FrameSettings::default(), Outputs::ALL)
//! }
//! ```
//!
//! `README.md` has a whole program, `docs/embedding.md` the contract with a host, `docs/walkthrough.md` one patch's way
//! through a frame.
#![warn(missing_docs)]

/// Vulkan's bindings and the vectors, in the versions that this crate uses in its types.
pub use {ash, glam};

/// An allocator that hosts may share, in the version that this crate uses in its types.
#[cfg(feature = "gpu-allocator")]
pub use gpu_allocator;

/// Models and their geometry: `selvedge-geometry`.
pub use selvedge_geometry::{construct, csg, edges, model, spline, trim};

/// For tests and benchmarks.
#[doc(hidden)]
pub use selvedge_geometry::math;

/// lets shared test shapes name the library as its users do
#[cfg(test)]
extern crate self as selvedge;

mod abi;
/// Baselines for comparisons; not part of the interface for hosts.
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
pub mod picture;
pub mod renderer;
mod scene;
mod shaders;
#[cfg(any(test, feature = "baselines"))]
mod twin;

/// For tests and measurements: the data that shaders read, the results of passes on the CPU, and one pass.
#[cfg(feature = "baselines")]
#[doc(hidden)]
pub mod internals {
    pub use crate::frame::common::scan;
    pub use crate::scene::seen_by;
    /// The structures that Rust and GLSL share.
    pub mod abi {
        pub use crate::abi::*;
    }
    /// The CPU twins of the passes.
    pub mod twin {
        pub use crate::twin::*;
    }
}

/// The examples of the README compile.
#[cfg(all(doctest, feature = "headless"))]
#[doc = include_str!("../README.md")]
struct Readme;
