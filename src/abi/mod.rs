//! The structures that Rust and GLSL share, in scalar layout. Twins of `glsl/include/scene.glsl`
//! and `view.glsl`; the build asserts every offset and stride against the compiled shaders.

mod frame;
mod scan;
mod scene;

pub use frame::*;
pub use scan::ScanParams;
pub use scene::*;

include!(concat!(env!("OUT_DIR"), "/spirv/layout.rs"));
