//! Baselines: other methods for a pass' work, for benchmarks and tests. They are not part of the embedders' interface.
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
//! Each follows its source, and is tuned where the source leaves a choice, so the comparison is fair. On the GPU, a
//! baseline uses the same interfaces as the engine's own ways, behind the feature `baselines`. `SceneOptions` selects
//! it, in addition to a host's settings.

pub mod bisect;
pub mod factors;
mod holes;
mod options;
pub mod pretessellated;
pub mod slefe;
pub mod texture;

pub use holes::many_holes;
pub use options::{SceneOptions, Sorted, TrimMethod};
