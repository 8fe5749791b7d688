//! Boxes of trimmed faces, against closed forms and against points found without them.

mod damage;
mod framing;
mod free;
mod many;
mod solids;
pub mod support;
