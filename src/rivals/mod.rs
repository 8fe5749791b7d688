//! Other ways to trim, for benchmarks and tests to put beside the engine's own. No embedder gets them.
//!
//! | way | decides | knob |
//! |---|---|---|
//! | [`bisect`] | per pixel: monotone pieces, bisected | steps |
//! | [`pretessellated`] | once, before the first frame: triangles | chord deflection |
//!
//! Each is written as its source says, and tuned where that leaves room, so that a comparison is worth
//! something.

pub mod bisect;
mod holes;
pub mod pretessellated;

pub use holes::many_holes;
