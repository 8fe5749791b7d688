//! Baselines: each way to trim is as exact as its parameter promises, so that comparisons are fair; the slefe table is
//! derived again.

mod bisect;
mod frame;
mod holes;
mod pretessellated;
mod program;
mod simplex;
mod slefe;
#[path = "../watched/mod.rs"]
mod watched;
