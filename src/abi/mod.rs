//! The structures that Rust and GLSL share, in scalar layout. Twins of `glsl/include/scene.glsl`,
//! `view.glsl`, `border_pixel.glsl`, `border_seen.glsl`, `edges.glsl`, `exact.glsl`, `solids.glsl`, `tiles.glsl` and `sun.glsl`; the build asserts every offset and stride
//! against the compiled shaders.

// Fields carry their meaning and units in the GLSL, which the build holds them against.
#![allow(missing_docs)]

mod borders;
mod edges;
mod exact;
mod frame;
mod scan;
mod scene;
mod solids;
mod sun;

pub use borders::*;
pub use edges::*;
pub use exact::*;
pub use frame::*;
pub use scan::ScanParams;
pub use scene::*;
pub use solids::*;
pub use sun::*;

include!(concat!(env!("OUT_DIR"), "/spirv/layout.rs"));

/// The constants of `glsl/`, a module a file: what Rust and GLSL share is stated there alone.
#[allow(dead_code, clippy::approx_constant, clippy::excessive_precision)] // GLSL has some for itself
pub mod constants {
    include!(concat!(env!("OUT_DIR"), "/spirv/constants.rs"));
}
