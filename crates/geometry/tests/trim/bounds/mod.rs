//! Boxes of what the trims leave, against closed forms and against points searched for without them.

mod damage;
mod framing;
mod free;
mod solids;
pub mod support;
