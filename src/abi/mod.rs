//! Structs shared with GLSL, in scalar layout: twins of `glsl/include/abi/*`.
//!
//! Every public struct here has a namesake in a buffer or push-constant block of the shaders; the
//! build reads its offsets and size out of the SPIR-V, and a mismatch does not compile.

mod scan;

pub use scan::ScanParams;

include!(concat!(env!("OUT_DIR"), "/spirv/layout.rs"));
