//! Trimmed rational B-spline surfaces, Boolean solids and their construction: plain `f64` data and the mathematics on
//! it, without a GPU.
//!
//! ```text
//!   math ◀─ spline ◀─ model ◀─ trim
//!                 csg ◀┘ ▲ ▲     ▲
//!       edges, silhouette ┘ └─────┴── construct         measure uses edges, trim, and what these use
//! ```
//!
//! [`model`] is the data that a renderer draws; [`spline`] and [`trim`] evaluate it; [`edges`] finds where its faces
//! meet, [`silhouette`] where a view sees them fold; [`measure`] has lengths, areas, volumes and distances; [`csg`] has
//! Boolean expressions; [`construct`] makes surfaces and solids from curves, data, equations and dimensions.
#![warn(missing_docs)]
#![forbid(unsafe_code)]

/// The vectors and matrices of this crate's types.
pub use glam;

pub mod construct;
pub mod csg;
pub mod edges;
pub mod math;
pub mod measure;
pub mod model;
pub mod silhouette;
pub mod spline;
pub mod trim;
