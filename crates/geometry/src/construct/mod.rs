//! Surfaces made from curves, equations and data, as rational B-splines: exact where a spline can be, else with a
//! measured bound of the error.
//!
//! ```text
//!   extrude        lathe          sweep            ruled, loft        Coons, Gordon
//!
//!    ┌────┐        ╭──│──╮        ╭───╮            ─────── c2         ──────────
//!    │ │  │ d      │  │  │        │   ╰──path      ───────── c1       │  │  │  │
//!    │ ▼  │        ╰──│──╯      profile            ──── c0            ──────────
//!    profile         axis                                             curves both ways
//! ```
//!
//! | from | module |
//! |---|---|
//! | conics, chains of Bézier segments, points in a row | [`curve`] |
//! | closed control polygons | [`polyloop`] |
//! | equations `S(u, v)`, as closures or as text | [`fit`] |
//! | grids of points, pictures of heights | [`grid`] |
//! | outlines cast on a surface | [`project()`] |
//! | dimensions: blocks, balls, gears, a pot | [`shapes`] |
//! | control meshes | [`subdivide`] |
//!
//! | result | meaning |
//! |---|---|
//! | `Surface` | exact: the rounding of `f64`, below `1e-12` of the size |
//! | [`Built`] | within [`Built::deviation`] of the surface described, measured |
//!
//! Surfaces are made in their natural frame (a lathe turns about `z`) and placed by an affine map, which is exact.

mod capped;
mod compat;
mod coons;
pub mod curve;
mod error;
mod extrude;
pub mod fit;
mod frame;
mod gordon;
pub mod grid;
mod lathe;
mod loft;
mod motion;
mod offset;
pub mod polyloop;
mod project;
mod ruled;
pub mod shapes;
mod solid;
pub mod subdivide;
mod sweep;
mod tube;

pub use capped::capped_solid;
pub use compat::compatible;
pub use coons::{Boundary, coons};
pub use error::ConstructError;
pub use extrude::extrude;
pub use gordon::{Network, gordon};
pub use lathe::lathe;
pub use loft::loft;
pub use offset::offset;
pub use project::{Projected, project};
pub use ruled::ruled;
pub use solid::{Chain, extruded_solid, lathed_solid, trim_loops};
pub use sweep::Sweep;
pub use tube::tube;

use crate::spline::Surface;

/// A surface that may be an approximation.
#[derive(Clone, Debug, PartialEq)]
pub struct Built {
    /// The spline.
    pub surface: Surface,
    /// Largest distance between the spline and the surface described, at equal parameters, in model units. 0 when the
    /// spline is exact.
    pub deviation: f64,
}
