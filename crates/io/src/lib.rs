//! Files to models and back.
//!
//! ```text
//!   bytes ──import──▶ Model, warnings          analytic surfaces and edges through brep
//!   Model ──export──▶ STEP text
//!   Model ◀─native──▶ the engine's own form, bit for bit
//! ```
#![warn(missing_docs)]
#![forbid(unsafe_code)]

pub mod brep;
pub mod export;
pub mod import;
pub mod native;

use selvedge_geometry::{construct, csg, edges, math, model, spline, trim};
