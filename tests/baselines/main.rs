//! Ways that the engine is compared with: those to trim are each as exact as its own knob says, or a comparison with
//! it would be worth nothing; slefe tables are derived again.

mod bisect;
mod frame;
mod holes;
mod pretessellated;
mod program;
mod simplex;
mod slefe;
#[path = "../watched/mod.rs"]
mod watched;
