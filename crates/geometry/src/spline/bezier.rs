//! A rational Bézier curve, and a piece of a B-spline as one.

use super::{Control, bernstein};
use crate::math::bernstein::split;

/// A rational Bézier curve over `[0, 1]`; `points.len() - 1` is its degree.
#[derive(Clone, Debug, PartialEq)]
pub struct Bezier<P> {
    /// Homogeneous control points.
    pub points: Vec<P>,
}

/// A Bézier piece of a B-spline, with the parameter range that it covers.
#[derive(Clone, Debug, PartialEq)]
pub struct Span<T> {
    /// Parameter at the start.
    pub start: f64,
    /// Parameter at the end; larger than `start`.
    pub end: f64,
    /// The piece, over `[0, 1]`.
    pub piece: T,
}

impl<P: Control> Bezier<P> {
    /// The straight line from `a` to `b`.
    pub fn line(a: P::Point, b: P::Point) -> Self {
        Self { points: vec![P::from_point(a, 1.0), P::from_point(b, 1.0)] }
    }

    /// Polynomial degree.
    pub fn degree(&self) -> usize {
        self.points.len() - 1
    }

    /// Homogeneous value at `t`.
    pub fn homogeneous(&self, t: f64) -> P {
        bernstein::horner(&self.points, t)
    }

    /// Point at `t`.
    pub fn point(&self, t: f64) -> P::Point {
        self.homogeneous(t).point()
    }

    /// Homogeneous value and derivative at `t`.
    pub fn jet(&self, t: f64) -> (P, P) {
        bernstein::horner_jet(&self.points, t)
    }

    /// The control points of `[0, t]` and of `[t, 1]`.
    pub fn split(&self, t: f64) -> (Self, Self) {
        let mut left = self.points.clone();
        let right = split(&mut left, t);
        (Self { points: left }, Self { points: right })
    }

    /// The piece over `[a, b]`, re-parametrised to `[0, 1]`.
    pub fn segment(&self, a: f64, b: f64) -> Self {
        if a == 0.0 && b == 1.0 {
            self.clone()
        } else if a < 1.0 {
            let (_, right) = self.split(a);
            let (left, _) = right.split((b - a) / (1.0 - a));
            left
        } else {
            let (left, _) = self.split(b);
            let (_, right) = left.split(a / b);
            right
        }
    }

    /// The same curve run backwards.
    pub fn reversed(mut self) -> Self {
        self.points.reverse();
        self
    }

    /// All weights equal (within rounding): a polynomial curve.
    pub fn is_polynomial(&self) -> bool {
        let w = self.points[0].weight();
        self.points.iter().all(|p| (p.weight() - w).abs() <= 1e-14 * w.abs())
    }

    /// Degree raised by one, exactly.
    pub fn elevated(&self) -> Self {
        let n = self.degree();
        let points = (0..=n + 1)
            .map(|i| {
                let a = i as f64 / (n + 1) as f64;
                let before = if i > 0 { self.points[i - 1] } else { P::ZERO };
                let here = if i <= n { self.points[i] } else { P::ZERO };
                before * a + here * (1.0 - a)
            })
            .collect();
        Self { points }
    }
}
