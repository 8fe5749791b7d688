//! The structures that Rust and GLSL share, in scalar layout. Twins of `glsl/include/scene.glsl`
//! and `view.glsl`; the build asserts every offset and stride against the compiled shaders.

// Fields carry their meaning and units in the GLSL, which the build holds them against.
#![allow(missing_docs)]

mod frame;
mod scan;
mod scene;

pub use frame::*;
pub use scan::ScanParams;
pub use scene::*;

include!(concat!(env!("OUT_DIR"), "/spirv/layout.rs"));
