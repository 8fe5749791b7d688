//! Selvedge draws trimmed spline surfaces exactly, at the resolution of the picture.
//!
//! Start at [`model`] for what is drawn and `ARCHITECTURE.md` for how.
#![warn(missing_docs)]

pub mod brep;
#[cfg(feature = "headless")]
pub mod headless;
pub mod import;
pub mod model;
pub mod picture;
pub mod reference;
pub mod spline;

/// The examples of the README compile.
#[cfg(all(doctest, feature = "headless"))]
#[doc = include_str!("../README.md")]
struct Readme;
