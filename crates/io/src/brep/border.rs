//! Edges that run along a border of their spline surface and share its control points.
//!
//! ```text
//!   S(u, v1) = C(t)    u = u0 + (u1 - u0) (t - t0) / (t1 - t0)        or run the other way
//! ```
//!
//! Modellers cut such edges out of the surface and write the same numbers twice. Two curves of the same degree, knots
//! and weights are nowhere farther apart than their control points. So the pre-image is known, and no point is
//! inverted.

use super::curve::Curve;
use super::edge::EdgeCurve;
use super::spline::SplineForm;
use crate::spline::{Bezier, Control};
use glam::{DVec2, DVec4};

/// A border that an edge runs along.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Border {
    /// The coordinate that is fixed along it: 0 for `u`, 1 for `v`.
    pub axis: usize,
    /// Its value.
    pub value: f64,
    /// The other coordinate where the curve's domain begins and ends.
    ends: (f64, f64),
    /// The curve's domain.
    domain: (f64, f64),
    /// Largest distance in mm of a control point from its counterpart: no point of the edge is farther from the border.
    pub gap: f64,
}

/// Relative difference up to which two knots, or two weights, count as equal: rounding.
const SAME: f64 = 1e-12;

impl Border {
    /// The border that is the edge's curve within `reach`, mm; surfaces and curves that close have none.
    pub fn of(spline: &SplineForm, edge: &EdgeCurve, reach: f64) -> Option<Self> {
        let Curve::Pieces(curve) = &edge.curve else { return None };
        if spline.closed != [false; 2] || curve.closed {
            return None;
        }
        let domain = curve.domain();
        let share = |t: f64, (a, b): (f64, f64)| (t - a) / (b - a);
        for axis in 0..2 {
            let along = spline.domain[1 - axis];
            for value in [spline.domain[axis].0, spline.domain[axis].1] {
                let Some(border) = spline.border(axis, value, curve.spans.len(), curve.spans[0].piece.degree()) else {
                    continue;
                };
                for turned in [false, true] {
                    let ends = if turned { (along.1, along.0) } else { along };
                    let mut gap: f64 = 0.0;
                    let same = curve.spans.iter().enumerate().all(|(i, span)| {
                        let other = &border[if turned { border.len() - 1 - i } else { i }];
                        let start = if turned { other.end } else { other.start };
                        gap = gap.max(apart(&span.piece, &other.piece, turned));
                        gap <= reach && (share(span.start, domain) - share(start, ends)).abs() <= SAME
                    });
                    if same {
                        return Some(Self { axis, value, ends, domain, gap });
                    }
                }
            }
        }
        None
    }

    /// The pre-image of the curve's point at `t`.
    pub fn at(&self, t: f64) -> DVec2 {
        let share = (t - self.domain.0) / (self.domain.1 - self.domain.0);
        let along = self.ends.0 * (1.0 - share) + self.ends.1 * share;
        if self.axis == 0 { DVec2::new(self.value, along) } else { DVec2::new(along, self.value) }
    }
}

/// Largest distance in mm between control points of two pieces of one degree; infinite where their weights differ by
/// more than a common factor.
fn apart(piece: &Bezier<DVec4>, points: &[DVec4], turned: bool) -> f64 {
    let n = points.len();
    let other = |i: usize| points[if turned { n - 1 - i } else { i }];
    let factor = piece.points[0].w / other(0).w;
    let distance = |(i, p): (usize, &DVec4)| {
        let q = other(i);
        let weighted = (p.w - factor * q.w).abs() <= SAME * p.w;
        if weighted { p.point().distance(q.point()) } else { f64::INFINITY }
    };
    piece.points.iter().enumerate().map(distance).fold(0.0, f64::max)
}
