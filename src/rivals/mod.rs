//! Other ways to trim, for benchmarks and tests to put beside the engine's own. No embedder gets them.
//!
//! | way | decides | knob |
//! |---|---|---|
//! | [`bisect`] | per pixel: monotone pieces, bisected | steps |
//! | [`texture`] | per pixel: one bit of a texture drawn for this view | texels to a pixel |
//! | [`pretessellated`] | once, before the first frame: triangles | chord deflection |
//!
//! Each is written as its source says, and tuned where that leaves room, so that a comparison is worth
//! something. What they need on the GPU hangs on the same seam as the engine's own ways
//! ([`TrimWay::Rival`](crate::picture::TrimWay)), behind the feature `rivals`.

pub mod bisect;
mod holes;
pub mod pretessellated;
pub mod texture;

pub use holes::many_holes;
