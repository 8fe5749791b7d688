//! Curves of the standard, made ready for evaluation, inversion and exact conversion.
//!
//! ```text
//!   Line        o + t d                      Parabola    o + t² x + t y
//!   Ellipse     o + cos t x + sin t y        Hyperbola   o + cosh t x + sinh t y
//!   Pieces      rational Bézier pieces       (x and y here carry the lengths)
//! ```

use super::law::{Axis, Law, TURN};
use super::pieces::Pieces;
use super::{CurveGeometry, Frame};
use crate::spline::arc::{self, sin_cos};
use crate::spline::{Bezier, Control, Span};
use glam::{DVec3, DVec4};

/// A curve in space. Reversal changes the curve, so that callers only ever run forward.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub(super) enum Curve {
    Line { origin: DVec3, direction: DVec3 },
    Ellipse { centre: DVec3, x: DVec3, y: DVec3 },
    Hyperbola { centre: DVec3, x: DVec3, y: DVec3 },
    Parabola { apex: DVec3, x: DVec3, y: DVec3 },
    Pieces(Pieces),
}

impl Curve {
    /// `eps`: distance in mm at which two ends are the same point. A trimmed curve becomes its
    /// basis curve, turned around when it runs backwards: the vertices of its edge bound it.
    ///
    /// # Errors
    /// Why its numbers define no curve.
    pub fn new(geometry: &CurveGeometry, eps: f64) -> Result<Self, &'static str> {
        let axes = |f: &Frame, a: f64, b: f64| {
            let positive = a > 0.0 && b > 0.0 && a.is_finite() && b.is_finite();
            match (f.is_orthonormal(), positive) {
                (false, _) => Err("its frame is not orthonormal"),
                (_, false) => Err("a radius is not positive"),
                _ => Ok((f.origin, f.x * a, f.y * b)),
            }
        };
        Ok(match geometry {
            CurveGeometry::Line { origin, direction } => {
                if !(origin.is_finite() && direction.is_finite() && direction.length_squared() > 0.0) {
                    return Err("a line without direction");
                }
                Self::Line { origin: *origin, direction: *direction }
            }
            CurveGeometry::Circle { frame, radius } => {
                let (centre, x, y) = axes(frame, *radius, *radius)?;
                Self::Ellipse { centre, x, y }
            }
            CurveGeometry::Ellipse { frame, semi_x, semi_y } => {
                let (centre, x, y) = axes(frame, *semi_x, *semi_y)?;
                Self::Ellipse { centre, x, y }
            }
            CurveGeometry::Hyperbola { frame, semi_x, semi_y } => {
                let (centre, x, y) = axes(frame, *semi_x, *semi_y)?;
                Self::Hyperbola { centre, x, y }
            }
            CurveGeometry::Parabola { frame, focal } => {
                let (apex, x, y) = axes(frame, *focal, 2.0 * focal)?;
                Self::Parabola { apex, x, y }
            }
            CurveGeometry::BSpline(c) => Self::Pieces(Pieces::of_spline(c, eps)),
            CurveGeometry::Trimmed { basis, forward, .. } => {
                let curve = Self::new(basis, eps)?;
                if *forward { curve } else { curve.reversed() }
            }
            CurveGeometry::Composite(segments) => {
                let mut pieces = Vec::new();
                for s in segments {
                    pieces.extend(segment(s, eps)?);
                }
                if pieces.is_empty() {
                    return Err("a composite curve without segments");
                }
                Self::Pieces(Pieces::chain(pieces, eps))
            }
        })
    }

    /// Point and derivative at `t`.
    pub fn jet(&self, t: f64) -> (DVec3, DVec3) {
        match self {
            Self::Line { origin, direction } => (origin + direction * t, *direction),
            Self::Ellipse { centre, x, y } => {
                let (s, c) = sin_cos(t);
                (centre + x * c + y * s, y * c - x * s)
            }
            Self::Hyperbola { centre, x, y } => (centre + x * t.cosh() + y * t.sinh(), x * t.sinh() + y * t.cosh()),
            Self::Parabola { apex, x, y } => (apex + x * (t * t) + y * t, x * (2.0 * t) + y),
            Self::Pieces(p) => p.jet(t),
        }
    }

    /// Point at `t`.
    pub fn point(&self, t: f64) -> DVec3 {
        self.jet(t).0
    }

    /// After how much the parameter repeats.
    pub fn period(&self) -> Option<f64> {
        match self {
            Self::Ellipse { .. } => Some(TURN),
            Self::Pieces(p) if p.closed => Some(p.domain().1 - p.domain().0),
            _ => None,
        }
    }

    /// Its parameter range, where it has one.
    pub fn domain(&self) -> Option<(f64, f64)> {
        match self {
            Self::Ellipse { .. } => Some((0.0, TURN)),
            Self::Pieces(p) => Some(p.domain()),
            _ => None,
        }
    }

    /// How its parameter maps to that of its rational pieces.
    pub fn law(&self) -> Law {
        match self {
            Self::Ellipse { .. } => Law::Angle,
            Self::Hyperbola { .. } => Law::Hyperbolic,
            _ => Law::Linear,
        }
    }

    /// The same points in the opposite order.
    pub fn reversed(&self) -> Self {
        match *self {
            Self::Line { origin, direction } => Self::Line { origin, direction: -direction },
            Self::Ellipse { centre, x, y } => Self::Ellipse { centre, x, y: -y },
            Self::Hyperbola { centre, x, y } => Self::Hyperbola { centre, x, y: -y },
            Self::Parabola { apex, x, y } => Self::Parabola { apex, x, y: -y },
            Self::Pieces(ref p) => Self::Pieces(p.reversed()),
        }
    }

    /// The parameter on [`Curve::reversed`] of the point at `t`.
    pub fn reversed_parameter(&self, t: f64) -> f64 {
        match self {
            Self::Pieces(p) => p.domain().0 + p.domain().1 - t,
            _ => -t,
        }
    }

    /// Parameter of the point of the curve nearest to `p`: closed form on conics (exact for points
    /// on the curve), Gauss-Newton from the best samples on splines.
    pub fn closest(&self, p: DVec3) -> f64 {
        let along = |d: DVec3, a: DVec3| d.dot(a) / a.length_squared();
        match self {
            Self::Line { origin, direction } => along(p - origin, *direction),
            Self::Ellipse { centre, x, y } => along(p - centre, *y).atan2(along(p - centre, *x)),
            Self::Hyperbola { centre, y, .. } => along(p - centre, *y).asinh(),
            Self::Parabola { apex, y, .. } => along(p - apex, *y),
            Self::Pieces(pieces) => {
                let distance = |t: f64| pieces.jet(t).0.distance_squared(p);
                let polished = best_seeds(&pieces.seeds(), distance).into_iter().map(|t| self.polish(t, p));
                polished.min_by(|a, b| distance(*a).total_cmp(&distance(*b))).unwrap_or(pieces.domain().0)
            }
        }
    }

    /// [`Curve::closest`], or the end of an open curve that is within `eps`, mm, of `p`.
    pub fn at_vertex(&self, p: DVec3, eps: f64) -> f64 {
        let end = match self {
            Self::Pieces(c) if !c.closed => {
                let (a, b) = c.domain();
                [a, b].into_iter().find(|t| c.jet(*t).0.distance(p) <= eps)
            }
            _ => None,
        };
        end.unwrap_or_else(|| self.closest(p))
    }

    /// Gauss-Newton on `(C(t) - p) · C'(t) = 0`, kept inside the domain.
    fn polish(&self, t: f64, p: DVec3) -> f64 {
        let clamp = |t: f64| match self {
            Self::Pieces(c) => c.wrap(t),
            _ => t,
        };
        let mut best = (self.point(t).distance_squared(p), t);
        let mut t = t;
        for _ in 0..30 {
            let (c, d) = self.jet(t);
            let next = clamp(t + (p - c).dot(d) / d.length_squared().max(f64::MIN_POSITIVE));
            let step = (next - t).abs();
            t = next;
            let distance = self.point(t).distance_squared(p);
            if distance < best.0 {
                best = (distance, t);
            }
            if step <= 1e-15 * t.abs().max(1e-3) {
                break;
            }
        }
        best.1
    }

    /// The part over `[a, b]` as rational Bézier pieces, exact; inside each the local parameter
    /// follows [`Curve::law`].
    pub fn beziers(&self, a: f64, b: f64) -> Vec<Span<Bezier<DVec4>>> {
        let each = |piece: &dyn Fn(f64, f64) -> Bezier<DVec4>| {
            let knots = Axis::new(self.law(), a, b).knots;
            knots.windows(2).map(|k| Span { start: k[0], end: k[1], piece: piece(k[0], k[1]) }).collect()
        };
        let single = |points: Vec<DVec4>| vec![Span { start: a, end: b, piece: Bezier { points } }];
        let h = |p: DVec3| DVec4::from_point(p, 1.0);
        match self {
            Self::Line { .. } => single(vec![h(self.point(a)), h(self.point(b))]),
            Self::Parabola { .. } => {
                let ((pa, da), pb) = (self.jet(a), self.point(b));
                single(vec![h(pa), h(pa + da * (0.5 * (b - a))), h(pb)])
            }
            Self::Ellipse { centre, x, y } => each(&|a, b| arc::arc(*centre, *x, *y, a, b)),
            Self::Hyperbola { centre, x, y } => each(&|a, b| {
                // weights (1, cosh h, 1): the middle point is where the end tangents meet
                let (middle, weight) = (0.5 * (a + b), (0.5 * (b - a)).cosh());
                let top = (centre * weight + x * middle.cosh() + y * middle.sinh()).extend(weight);
                Bezier { points: vec![h(self.point(a)), top, h(self.point(b))] }
            }),
            Self::Pieces(p) => p.between(a, b),
        }
    }

    /// Increasing parameters from `a` to `b`, dense where the curve bends.
    pub fn nodes(&self, a: f64, b: f64) -> Vec<f64> {
        let even = |n: usize| (0..=n).map(|i| a + (b - a) * (i as f64 / n as f64)).collect::<Vec<f64>>();
        match self {
            Self::Line { .. } => even(8),
            // an eighth of a quarter turn: sagitta 0.5 % of the radius
            Self::Ellipse { .. } => even(((b - a) / (TURN / 32.0)).ceil().max(6.0) as usize),
            Self::Hyperbola { .. } | Self::Parabola { .. } => even(16),
            Self::Pieces(p) => p.nodes(a, b),
        }
    }

    /// Parameters strictly inside `[a, b]` where the second derivative may jump.
    pub fn creases(&self, a: f64, b: f64) -> Vec<f64> {
        let Self::Pieces(p) = self else { return Vec::new() };
        let (lo, hi) = p.domain();
        let all = p.creases.iter().copied().chain(p.closed.then_some(lo));
        repeated(all, p.closed.then_some(hi - lo), a, b)
    }
}

/// The values, repeated by the period, that lie strictly inside `(a, b)`; sorted.
pub(super) fn repeated(values: impl Iterator<Item = f64>, period: Option<f64>, a: f64, b: f64) -> Vec<f64> {
    let margin = 1e-9 * (b - a);
    let mut out = Vec::new();
    for x in values {
        match period {
            None => out.push(x),
            Some(p) => {
                let first = ((a - x) / p).ceil();
                let count = ((b - a) / p).ceil() as i64;
                out.extend((0..=count).map(|k| x + p * (first + k as f64)));
            }
        }
    }
    out.retain(|x| *x > a + margin && *x < b - margin);
    out.sort_by(f64::total_cmp);
    out
}

/// The local minima of `distance` over consecutive seeds, the four nearest.
pub(super) fn best_seeds(seeds: &[f64], distance: impl Fn(f64) -> f64) -> Vec<f64> {
    let d: Vec<f64> = seeds.iter().map(|t| distance(*t)).collect();
    let lower = |i: usize, j: Option<usize>| j.and_then(|j| d.get(j)).is_none_or(|other| d[i] <= *other);
    let mut minima: Vec<usize> =
        (0..d.len()).filter(|&i| lower(i, i.checked_sub(1)) && lower(i, Some(i + 1))).collect();
    minima.sort_by(|a, b| d[*a].total_cmp(&d[*b]));
    minima.truncate(4);
    minima.into_iter().map(|i| seeds[i]).collect()
}

/// One segment of a composite curve as Bézier pieces in its own direction.
pub(super) fn segment(geometry: &CurveGeometry, eps: f64) -> Result<Vec<Bezier<DVec4>>, &'static str> {
    let whole = |curve: Curve, (a, b): (f64, f64)| curve.beziers(a, b).into_iter().map(|s| s.piece).collect();
    match geometry {
        CurveGeometry::Trimmed { basis, start, end, forward } => {
            let mut curve = Curve::new(basis, eps)?;
            let (mut a, mut b) = (*start, *end);
            if !forward {
                (a, b) = (curve.reversed_parameter(a), curve.reversed_parameter(b));
                curve = curve.reversed();
            }
            if let Some(period) = curve.period() {
                b = a + (b - a).rem_euclid(period);
                b = if b - a <= 1e-12 * period { a + period } else { b };
            }
            if !(a.is_finite() && b.is_finite() && b > a) {
                return Err("a segment of its composite curve has an empty range");
            }
            Ok(whole(curve, (a, b)))
        }
        CurveGeometry::Composite(inner) => {
            let parts: Result<Vec<_>, _> = inner.iter().map(|s| segment(s, eps)).collect();
            Ok(parts?.into_iter().flatten().collect())
        }
        _ => {
            let curve = Curve::new(geometry, eps)?;
            let range = curve.domain().ok_or("an unbounded segment of its composite curve")?;
            Ok(whole(curve, range))
        }
    }
}
