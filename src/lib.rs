//! Selvedge draws trimmed spline surfaces exactly, at the resolution of the picture.
//!
//! Start at [`model`] for what is drawn and `ARCHITECTURE.md` for how.
#![warn(missing_docs)]

pub mod brep;
pub mod model;
pub mod picture;
pub mod reference;
pub mod spline;
pub mod trim;
