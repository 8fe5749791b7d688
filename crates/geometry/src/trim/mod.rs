//! Which points of a domain belong to the trimmed face: the exact test, and the table that decides fast.
//!
//! ```text
//!   v ▲      ╭───<───╮         winding number of p = sum over the curves right of p on its scan line:
//!     │      │   p───│──>      +1 where the curve climbs, -1 where it falls
//!     │      ╰───>───╯
//!     └─────────────────▶ u    p belongs to the face when the sum is not zero
//! ```
//!
//! Two half-open rules make every answer unique, also at vertices and on the curves themselves:
//!
//! * a curve piece from `v0` up to `v1` crosses the scan line `v` when `v0 < v <= v1`
//!   (*bottom-open, top-closed*), so the two pieces at a vertex count once together where the loop
//!   passes through the scan line and cancel where it only touches it;
//! * a crossing at `u_c` is right of `u` when `u_c > u`.
//!
//! So a counter-clockwise unit square keeps `0 <= u < 1`, `0 < v <= 1`, and faces that tile a domain
//! own each point once. Loops that cross themselves or each other follow the non-zero rule.
//!
//! | item | answers | cost |
//! |---|---|---|
//! | [`LoopIndex`] | winding number, rectangle class, distance: exact curves | `O(log n)` |
//! | [`TrimTable`] | in or out, by scan line, the way the GPU does | one binary search |
//! | [`ExactTrim`] | winding number in single precision, as the GPU does without a table | a few arcs |
//! | [`Face::bounds`], [`Part::bounds`], [`Model::bounds`] | how far the kept points reach | branch and bound |
//! | [`crossing`] | whether loops cross | nearly linear |
//! | [`each_pair`] | boxes that meet | nearly linear |
//! | [`chord_bend, segment_count`] | how many chords stay within a tolerance | closed form |
//!
//! Sources: R. Wu, J. Peters, *Correct resolution rendering of trimmed spline surfaces*, 2014 (the
//! table and the half-open segments); A. Schollmeyer, B. Fröhlich, *Direct trimming of NURBS
//! surfaces on the GPU*, 2009 (bi-monotone pieces).
//!
//! [`Face::bounds`]: crate::model::Face::bounds
//! [`Part::bounds`]: crate::model::Part::bounds
//! [`Model::bounds`]: crate::model::Model::bounds

mod bounds;
mod classify;
mod crossing;
mod distance;
mod exact;
mod flatten;
mod meet;
mod piece;
mod table;
mod winding;

pub use bounds::{ANALYTIC, OTHER};
pub use classify::RectSide;
pub use crossing::{Crossing, crossing};
pub use exact::{AT_HIGH, AT_LOW, Cell, Entry, ExactTrim, MARGIN};
pub use flatten::{chord_bend, polyline, segment_count};
pub use meet::{Box2, each_pair};
pub use piece::{MonotonePiece, monotone_pieces};
pub use table::TrimTable;
pub use winding::LoopIndex;

/// Crossings of the scan line `v`, with sign, of any curve that runs from ordinate `from` to `to`:
/// `+1` up, `-1` down, `0` when both ends lie on the same side. Bottom-open, top-closed.
///
/// Sums telescope over a chain, so the two ends of a chain determine its crossings.
fn climbs(from: f64, to: f64, v: f64) -> i32 {
    i32::from(to >= v) - i32::from(from >= v)
}
