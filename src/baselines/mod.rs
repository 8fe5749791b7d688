//! Other ways to do a pass' work, for benchmarks and tests to put beside the engine's own. No embedder gets them.
//!
//! | way to trim | decides | knob |
//! |---|---|---|
//! | `bisect` | per pixel: monotone pieces, bisected | steps |
//! | `texture` | per pixel: one bit of a texture drawn for this view | texels to a pixel |
//! | `pretessellated` | once, before the first frame: triangles | chord deflection |
//!
//! | way to divide | by | knob |
//! |---|---|---|
//! | `factors` | several bounds behind one interface, `slefe`s among them | cuts, segments, level |
//!
//! Each is written as its source says, and tuned where that leaves room, so that a comparison is worth
//! something. What they need on the GPU hangs on the same seam as the engine's own ways, behind the feature `baselines`:
//! `SceneOptions` beside a host's settings say what a scene is made by.

pub mod bisect;
pub mod factors;
mod holes;
mod options;
pub mod pretessellated;
pub mod slefe;
pub mod texture;

pub use holes::many_holes;
pub use options::{SceneOptions, Sorted, TrimMethod};
