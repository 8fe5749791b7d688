//! The structures that Rust and GLSL share, in scalar layout. Twins of `glsl/include/scene.glsl`,
//! `view.glsl`, `parts.glsl`, `border_pixel.glsl`, `border_around.glsl`, `border_followed.glsl`, `edges.glsl`, `line_list.glsl`, `exact.glsl`, `solids.glsl`, `tiles.glsl` and `sun.glsl`; the build asserts every offset and stride
//! against the compiled shaders.

// the GLSL states the meaning and units of the fields; the build compares both
#![allow(missing_docs)]

mod borders;
mod edges;
mod exact;
mod frame;
mod parts;
mod scan;
mod scene;
mod solids;
mod sun;

pub use borders::*;
pub use edges::*;
pub use exact::*;
pub use frame::*;
pub use parts::*;
pub use scan::ScanParams;
pub use scene::*;
pub use solids::*;
pub use sun::*;

include!(concat!(env!("OUT_DIR"), "/spirv/layout.rs"));

/// The constants of `glsl/`, one module a file. Constants that Rust and GLSL share are stated only there.
#[allow(dead_code, clippy::approx_constant, clippy::excessive_precision)] // some constants are used only in GLSL
pub mod constants {
    include!(concat!(env!("OUT_DIR"), "/spirv/constants.rs"));
}
