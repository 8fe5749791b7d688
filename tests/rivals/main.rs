//! Ways to trim that the engine is compared with: each is as exact as its own knob says, or a comparison
//! with it would be worth nothing.

mod bisect;
mod frame;
mod holes;
mod pretessellated;
