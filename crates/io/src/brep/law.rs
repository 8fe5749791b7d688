//! How a parameter of the standard maps to the parameter of a rational spline.
//!
//! The angle of a circle is not the parameter of its rational quadratic pieces. Over one piece
//! `[a, b]` with middle `m` and half width `h`, the Bézier parameter `t` of the point at angle `x` is
//!
//! ```text
//!   tan((x - m) / 2) = (2 t - 1) tan(h / 2)          circle, ellipse
//!   tanh((x - m) / 2) = (2 t - 1) tanh(h / 2)        hyperbola
//! ```
//!
//! The knots of a carrier are the angles at the ends of its pieces, so its domain still reads in
//! radians, exactly so at the knots, and a line of constant angle stays a line.
//!
//! Source: L. Piegl, W. Tiller, *The NURBS Book*, 1997, section 7.3.

use crate::spline::arc;
use std::f64::consts::{FRAC_PI_2, TAU};

/// The kind of a parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Law {
    /// The spline's own.
    Linear,
    /// An angle in radians.
    Angle,
    /// The parameter of `cosh` and `sinh`.
    Hyperbolic,
}

/// One direction of a carrier: its law and the ends of its pieces.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Axis {
    /// How parameters map inside a piece.
    pub law: Law,
    /// Ends of the pieces, where both parameters are the same number.
    pub knots: Vec<f64>,
}

impl Axis {
    /// Cuts `[lo, hi]` into pieces of equal width: at most 90 degrees for an angle (weights at least
    /// `1/√2`), at most 2 for a hyperbola (weights at most `cosh 1`).
    pub fn new(law: Law, lo: f64, hi: f64) -> Self {
        let widest = match law {
            Law::Linear => f64::INFINITY,
            Law::Angle => FRAC_PI_2,
            Law::Hyperbolic => 2.0,
        };
        Self { law, knots: arc::pieces(lo, hi, widest) }
    }

    /// Both parameters are the same number.
    pub fn is_linear(&self) -> bool {
        self.law == Law::Linear
    }

    /// The piece that `x` lies in; the end pieces reach beyond the range.
    fn piece(&self, x: f64) -> (f64, f64) {
        let i = self.knots.partition_point(|k| *k <= x).clamp(1, self.knots.len() - 1);
        (self.knots[i - 1], self.knots[i])
    }

    /// From the standard's parameter to the spline's.
    pub fn to_carrier(&self, x: f64) -> f64 {
        let (a, b) = self.piece(x);
        if self.law == Law::Linear || x == a || x == b {
            return x;
        }
        let (m, h) = (0.5 * (a + b), 0.5 * (b - a));
        let half = match self.law {
            // the tangent ends at half a turn from the middle; nothing sensible lies beyond
            Law::Angle => (0.5 * (x - m)).clamp(-0.5 * FRAC_PI_2 - 0.5, 0.5 * FRAC_PI_2 + 0.5).tan() / (0.5 * h).tan(),
            _ => (0.5 * (x - m)).tanh() / (0.5 * h).tanh(),
        };
        m + h * half
    }

    /// From the spline's parameter to the standard's.
    pub fn to_native(&self, x: f64) -> f64 {
        let (a, b) = self.piece(x);
        if self.law == Law::Linear || x == a || x == b {
            return x;
        }
        let (m, h) = (0.5 * (a + b), 0.5 * (b - a));
        let half = (x - m) / h;
        match self.law {
            Law::Angle => m + 2.0 * (half * (0.5 * h).tan()).atan(),
            _ => m + 2.0 * (half * (0.5 * h).tanh()).clamp(-1.0 + f64::EPSILON, 1.0 - f64::EPSILON).atanh(),
        }
    }
}

/// `x` moved by whole periods to within half a period of `near`.
pub(super) fn nearest(x: f64, near: f64, period: f64) -> f64 {
    x + period * ((near - x) / period).round()
}

/// The period of an angle.
pub(super) const TURN: f64 = TAU;
