//! Ruled surfaces: 118.
//!
//! ```text
//!        second curve                 both curves over [0, 1], of one degree and one knot vector;
//!     ●────●────●────●   v = 1        column i of the net joins their control points i
//!     │    │    │    │
//!     ●────●────●────●   v = 0
//!        first curve
//! ```
//!
//! Lines of the surface join points of equal parameters. Arcs use the rational parameter in place of the angle: the
//! lines are the same when both sides are arcs of one sweep, and nearly the same else.

use super::curve::Segment;
use crate::brep::CurveGeometry;
use crate::spline::{Bezier, Control, Span, SplineError, Surface};
use glam::{DVec3, DVec4};

/// One of the two sides.
#[derive(Clone, Debug)]
pub(super) enum Side {
    Point(DVec3),
    Curve(Vec<Segment>),
}

impl Side {
    /// Equal parameters are equal lengths.
    pub fn is_even(&self) -> bool {
        let even = |s: &Segment| matches!(s.curve, CurveGeometry::Line { .. } | CurveGeometry::Circle { .. });
        match self {
            Self::Point(_) => true,
            Self::Curve(segments) => segments.len() == 1 && segments.iter().all(even),
        }
    }

    /// Bézier pieces over `[0, 1]`; each segment of a composite gets its share of the parameters.
    fn pieces(self, turned: bool) -> Vec<Span<Bezier<DVec4>>> {
        let segments = match self {
            Self::Point(p) => {
                return vec![Span { start: 0.0, end: 1.0, piece: Bezier::line(p, p) }];
            }
            Self::Curve(segments) if turned => segments.into_iter().rev().map(Segment::reversed).collect(),
            Self::Curve(segments) => segments,
        };
        let whole: f64 = segments.iter().map(|s| s.end - s.start).sum();
        let mut before = 0.0;
        let mut out = Vec::new();
        for s in segments {
            for p in beziers(&s) {
                let at = |t: f64| ((before + t - s.start) / whole).clamp(0.0, 1.0);
                out.push(Span { start: at(p.start), end: at(p.end), piece: p.piece });
            }
            before += s.end - s.start;
        }
        if let Some(last) = out.last_mut() {
            last.end = 1.0;
        }
        out
    }
}

/// A segment as rational Bézier pieces; arcs in pieces of equal angle, at most a quarter turn.
fn beziers(s: &Segment) -> Vec<Span<Bezier<DVec4>>> {
    let conic = |middle: &dyn Fn(f64, f64) -> DVec4, count: usize| -> Vec<Span<Bezier<DVec4>>> {
        let at = |i: usize| s.start + (s.end - s.start) * i as f64 / count as f64;
        let end = |t: f64| s.point(t).extend(1.0);
        let piece = |i: usize| {
            let (a, b) = (at(i), at(i + 1));
            let points = vec![end(a), middle(0.5 * (a + b), 0.5 * (b - a)), end(b)];
            Span { start: a, end: b, piece: Bezier { points } }
        };
        (0..count).map(piece).collect()
    };
    let quarters = ((s.end - s.start) / std::f64::consts::FRAC_PI_2 - 1e-9).ceil().max(1.0) as usize;
    match &s.curve {
        CurveGeometry::BSpline(c) => c.beziers_between(s.start, s.end),
        // the middle point of an arc, scaled by the cosine of half its angle, is where its tangents meet
        CurveGeometry::Circle { frame, .. } | CurveGeometry::Ellipse { frame, .. } => {
            let top = |m: f64, h: f64| {
                let (centre, p) = (frame.origin, s.point(m));
                (centre * h.cos() + (p - centre)).extend(h.cos())
            };
            conic(&top, quarters)
        }
        CurveGeometry::Hyperbola { frame, .. } => {
            let top = |m: f64, h: f64| {
                let (centre, p) = (frame.origin, s.point(m));
                (centre * h.cosh() + (p - centre)).extend(h.cosh())
            };
            conic(&top, ((s.end - s.start) / 2.0).ceil().clamp(1.0, 64.0) as usize)
        }
        CurveGeometry::Parabola { frame, focal } => {
            // the tangents at a and b meet at ((a b) f, (a + b) f)
            let top = |m: f64, h: f64| {
                (frame.origin + frame.x * (focal * (m * m - h * h)) + frame.y * (2.0 * focal * m)).extend(1.0)
            };
            conic(&top, 1)
        }
        _ => vec![Span { start: s.start, end: s.end, piece: Bezier::line(s.point(s.start), s.point(s.end)) }],
    }
}

/// The surface between two sides; `turned` runs the second one backwards.
pub(super) fn surface(first: Side, second: Side, turned: bool) -> Result<Surface, SplineError> {
    let sides = [first.pieces(false), second.pieces(turned)];
    let degree = sides.iter().flatten().map(|s| s.piece.degree()).max().unwrap_or(1);
    // pieces of one side are cut where the other's begin
    let mut breaks: Vec<f64> = sides.iter().flatten().map(|s| s.start).chain([1.0]).collect();
    breaks.sort_by(f64::total_cmp);
    breaks.dedup_by(|b, a| *b - *a <= 1e-12);
    let rows = sides.map(|side| row(&side, &breaks, degree));
    let inner = breaks.iter().flat_map(|t| std::iter::repeat_n(*t, degree));
    let knots = [0.0].into_iter().chain(inner).chain([1.0]).collect();
    Surface::new((degree, 1), knots, vec![0.0, 0.0, 1.0, 1.0], rows.concat())
}

/// Control points of one side, cut at `breaks` and of the given degree.
fn row(side: &[Span<Bezier<DVec4>>], breaks: &[f64], degree: usize) -> Vec<DVec4> {
    let mut points: Vec<DVec4> = Vec::new();
    for w in breaks.windows(2) {
        let middle = 0.5 * (w[0] + w[1]);
        let Some(s) = side.get(side.partition_point(|s| s.end < middle)) else { continue };
        let length = s.end - s.start;
        let mut piece = s.piece.segment(((w[0] - s.start) / length).max(0.0), ((w[1] - s.start) / length).min(1.0));
        while piece.degree() < degree {
            piece = piece.elevated();
        }
        // joints are shared: weights are scaled to agree there
        let scale = points.last().map_or(1.0, |last| last.weight() / piece.points[0].weight());
        let skip = usize::from(!points.is_empty());
        points.extend(piece.points[skip..].iter().map(|p| *p * scale));
    }
    points
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::brep::Frame;
    use crate::spline::BSpline;

    /// Between two quarter circles about one axis lies a quarter of a cone: radius 2 at z = 0, 1 at z = 3.
    #[test]
    fn a_cone_between_arcs() {
        let side = |radius: f64, z: f64| {
            let frame = Frame { origin: DVec3::Z * z, ..Frame::WORLD };
            let curve = CurveGeometry::Circle { frame, radius };
            Side::Curve(vec![Segment { id: 1, curve, start: 0.2, end: 2.9 }])
        };
        let cone = surface(side(2.0, 0.0), side(1.0, 3.0), false).unwrap();
        for (u, v) in [(0.0, 0.0), (0.3, 0.2), (0.7, 0.9), (1.0, 1.0), (0.5, 0.5)] {
            let p = cone.jet(u, v).point;
            assert!((p.x.hypot(p.y) - (2.0 - p.z / 3.0)).abs() < 1e-14, "{p}");
        }
        let end = cone.jet(1.0, 1.0).point;
        assert!(end.distance(DVec3::new(2.9f64.cos(), 2.9f64.sin(), 3.0)) < 1e-15, "{end}");
    }

    /// A point and a polyline of two sides: two triangles.
    #[test]
    fn a_fan() {
        let points = [DVec3::ZERO, DVec3::X, DVec3::ONE].map(|p| p.extend(1.0));
        let spline = BSpline::new(1, vec![0.0, 0.0, 1.0, 2.0, 2.0], points.to_vec()).unwrap();
        let curve = CurveGeometry::BSpline(spline);
        let side = Side::Curve(vec![Segment { id: 1, curve, start: 0.0, end: 2.0 }]);
        let fan = surface(Side::Point(DVec3::Z), side, false).unwrap();
        assert_eq!(fan.counts(), (3, 2));
        assert_eq!(fan.jet(0.5, 1.0).point, DVec3::X);
        assert_eq!(fan.jet(0.9, 0.0).point, DVec3::Z);
    }
}
