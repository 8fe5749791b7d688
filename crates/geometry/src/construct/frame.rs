//! Frames of least turning along a path.
//!
//! ```text
//!   r_k ▲    ▲          ▲ r_{k+1}      reflect (r, t) in the plane between the points, then in the plane
//!       │   ╱ bisects  ╱               between the tangents: a rotation, and the frame of least turning
//!   x_k ●──┼─────────● x_{k+1}         to fourth order in the step
//! ```
//!
//! Source: W. Wang, B. Jüttler, D. Zheng, Y. Liu, *Computation of rotation minimizing frames*, ACM Transactions on
//! Graphics 27, 2008.

use super::ConstructError;
use crate::spline::{BSpline, Bezier, Control, Span};
use glam::{DVec3, DVec4};

/// A path that can be evaluated anywhere, with its first two derivatives.
pub(super) struct Path {
    spans: Vec<Span<Bezier<DVec4>>>,
    size: f64,
}

/// Derivatives of a path.
#[derive(Clone, Copy, Debug)]
pub(super) struct PathJet {
    pub point: DVec3,
    pub first: DVec3,
    pub second: DVec3,
}

impl PathJet {
    /// Unit tangent.
    pub fn tangent(&self) -> DVec3 {
        self.first.normalize()
    }

    /// The tangent's derivative.
    pub fn turning(&self) -> DVec3 {
        let (t, speed) = (self.tangent(), self.first.length());
        (self.second - t * self.second.dot(t)) / speed
    }
}

/// Share of the size below which a speed (over a domain of length 1) is no speed.
const STILL: f64 = 1e-9;
/// Sine of the angle between tangents above which a joint is a corner.
const CORNER: f64 = 1e-6;

impl Path {
    /// The path over `[0, 1]`.
    ///
    /// # Errors
    /// It has no length, stops, or has a corner.
    pub fn new(curve: &BSpline<DVec4>, what: &'static str) -> Result<Self, ConstructError> {
        let size = super::compat::size([curve]);
        if size == 0.0 {
            return Err(ConstructError::ZeroLength { what });
        }
        let this = Self { spans: curve.over(0.0, 1.0)?.beziers(), size };
        for (i, s) in this.spans.iter().enumerate() {
            // no stop at the ends of pieces or at points inside
            for k in 0..=16 {
                let x = f64::from(k) / 16.0;
                if this.local(i, x).first.length() <= STILL * size {
                    return Err(ConstructError::Cusp { what, parameter: s.start + (s.end - s.start) * x });
                }
            }
            if i > 0 {
                let (before, after) = (this.local(i - 1, 1.0).tangent(), this.local(i, 0.0).tangent());
                if before.distance(after) > CORNER {
                    return Err(ConstructError::Corner { what, parameter: s.start });
                }
            }
        }
        Ok(this)
    }

    /// The Bézier pieces.
    pub fn spans(&self) -> &[Span<Bezier<DVec4>>] {
        &self.spans
    }

    /// The end is the beginning, and goes on in its direction.
    pub fn closed(&self) -> bool {
        let (a, b) = (self.jet(0.0), self.local(self.spans.len() - 1, 1.0));
        a.point.distance(b.point) <= 1e-9 * self.size && a.tangent().distance(b.tangent()) <= CORNER
    }

    /// On piece `i` at `x` in `[0, 1]`, derivatives by the path's own parameter.
    pub fn local(&self, i: usize, x: f64) -> PathJet {
        let s = &self.spans[i];
        let length = s.end - s.start;
        let points = &s.piece.points;
        let n = points.len() - 1;
        let slope =
            |p: &[DVec4]| Bezier { points: p.windows(2).map(|w| (w[1] - w[0]) * (p.len() - 1) as f64).collect() };
        let d = slope(points);
        let (p, p1) = (s.piece.homogeneous(x), d.homogeneous(x));
        let p2 = if n > 1 { slope(&d.points).homogeneous(x) } else { DVec4::ZERO };
        let point = p.point();
        let first = (p1.truncate() - point * p1.w) / p.w;
        let second = (p2.truncate() - first * (2.0 * p1.w) - point * p2.w) / p.w;
        PathJet { point, first: first / length, second: second / (length * length) }
    }

    /// At `t` in `[0, 1]`; at a joint on the piece after it.
    pub fn jet(&self, t: f64) -> PathJet {
        let i = self.spans.partition_point(|s| s.start <= t).clamp(1, self.spans.len()) - 1;
        let s = &self.spans[i];
        self.local(i, ((t - s.start) / (s.end - s.start)).clamp(0.0, 1.0))
    }

    /// Length over `[a, b]`, inside one piece, by five-point Gauss quadrature.
    pub fn length(&self, a: f64, b: f64) -> f64 {
        const NODES: [(f64, f64); 3] = [
            (0.0, 0.568_888_888_888_888_9),
            (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
            (0.906_179_845_938_664, 0.236_926_885_056_189_08),
        ];
        let (m, h) = (0.5 * (a + b), 0.5 * (b - a));
        let speed = |x: f64| self.jet(m + h * x).first.length();
        let pairs = NODES.iter().map(|&(x, w)| if x == 0.0 { w * speed(0.0) } else { w * (speed(x) + speed(-x)) });
        h * pairs.sum::<f64>()
    }
}

/// A unit vector across `t`: the part of `up` across it, or of the axis farthest from it.
pub(super) fn across(t: DVec3, up: Option<DVec3>) -> DVec3 {
    let part = |r: DVec3| (r - t * r.dot(t)).try_normalize().filter(|x| x.dot(t).abs() < 1e-6);
    let axes = [DVec3::Z, DVec3::X, DVec3::Y];
    let axis = axes.into_iter().min_by(|a, b| a.dot(t).abs().total_cmp(&b.dot(t).abs())).unwrap_or(DVec3::Z);
    let normal = |r: DVec3| r.try_normalize().and_then(|r| part(r).filter(|_| r.cross(t).length() > 1e-6));
    up.and_then(normal).or_else(|| part(axis)).unwrap_or_else(|| t.any_orthonormal_vector())
}

/// The reference vector carried from one point of a path to another.
pub(super) fn carried(r: DVec3, from: &PathJet, to: &PathJet) -> DVec3 {
    let reflect = |x: DVec3, n: DVec3| {
        let square = n.length_squared();
        if square > 0.0 { x - n * (2.0 * x.dot(n) / square) } else { x }
    };
    let step = to.point - from.point;
    let t = to.tangent();
    let r = reflect(reflect(r, step), t - reflect(from.tangent(), step));
    // rounding must not add up
    (r - t * r.dot(t)).normalize()
}
