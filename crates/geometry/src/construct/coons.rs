//! A surface inside four boundary curves.
//!
//! ```text
//!            top
//!        •─────────▶•          S = (ruled between bottom and top) + (ruled between left and right)
//!   left ▲          ▲ right        - (bilinear through the corners)
//!        •─────────▶•
//!           bottom
//! ```
//!
//! It is the [`gordon`](super::gordon()) surface of two curves each way. Rational curves are added in homogeneous
//! coordinates, after a change of parameter that makes their end weights 1, so that weights agree at the corners.
//!
//! Source: S. A. Coons, *Surfaces for computer-aided design of space forms*, 1967.

use super::ConstructError;
use super::compat::{compatible, unit_ends};
use super::gordon::{boolean_sum, gap_allowed};
use crate::spline::{BSpline, Surface};
use glam::DVec4;

/// Boundary curves; opposite ones run the same way.
#[derive(Clone, Copy, Debug)]
pub struct Boundary<'a> {
    /// `v = 0`, along `u`.
    pub bottom: &'a BSpline<DVec4>,
    /// `v = 1`, along `u`.
    pub top: &'a BSpline<DVec4>,
    /// `u = 0`, along `v`.
    pub left: &'a BSpline<DVec4>,
    /// `u = 1`, along `v`.
    pub right: &'a BSpline<DVec4>,
}

/// The bilinearly blended Coons surface, over the unit square; a boundary curve may be a point.
///
/// Its sides are the four curves, to rounding where they meet exactly, else within half of the gap at their corners.
///
/// # Errors
/// * A negative or NaN tolerance; curves more than `tolerance` apart at a corner.
/// * Opposite curves that coincide, with points between them.
/// * Weights below 1/2 of those at the corners, where the sum has one that is not positive.
pub fn coons(boundary: Boundary, tolerance: f64) -> Result<Surface, ConstructError> {
    let Boundary { bottom, top, left, right } = boundary;
    gap_allowed(tolerance)?;
    let ends = |c: &BSpline<DVec4>| (c.point(c.domain().0), c.point(c.domain().1));
    let (b, t, l, r) = (ends(bottom), ends(top), ends(left), ends(right));
    for (corner, (p, q)) in [(b.0, l.0), (b.1, r.0), (t.0, l.1), (t.1, r.1)].into_iter().enumerate() {
        let gap = p.distance(q);
        if gap > tolerance {
            return Err(ConstructError::CornerMismatch { corner, gap });
        }
    }
    let c = compatible(&[unit_ends(bottom)?, unit_ends(top)?])?;
    let d = compatible(&[unit_ends(left)?, unit_ends(right)?])?;
    boolean_sum(&c, &d, &[0.0, 1.0], &[0.0, 1.0])
}
