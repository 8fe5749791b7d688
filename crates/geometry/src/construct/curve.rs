//! Curves as rational B-splines, exactly: lines, arcs of conics, chains of Bézier segments; and curves through points.
//!
//! ```text
//!   line      circle, ellipse       parabola      hyperbola        chain of Bézier segments
//!                 ___
//!   ╱          ╱      ╲              ╲   ╱          ╲   ╱          P3 = Q0: neighbours share a point
//!  ╱          (   x,y  )              ╲_╱            ) (           global u: segment 0 over [0, 1],
//!              ╲ ___ ╱                              ╱   ╲          segment 1 over [1, 2], …
//! ```
//!
//! Source: L. Piegl, W. Tiller, *The NURBS Book*, 1997, chapter 7; parameters of data from E. T. Y. Lee, *Choosing
//! nodes in parametric curve interpolation*, 1989.

use super::ConstructError;
use crate::spline::arc::{arc, assemble, pieces};
use crate::spline::cubic::{Cubic, Ends};
use crate::spline::{BSpline, Bezier, Control, Span};
use glam::{DVec3, DVec4};
use std::f64::consts::{FRAC_PI_2, TAU};

/// Most turns of an arc.
const MOST_TURNS: f64 = 1024.0;
/// Most points of one curve.
pub const MOST_POINTS: usize = 1 << 20;
/// Neighbours closer than this share of the points' largest coordinate coincide.
const SAME: f64 = 1e-14;

/// Finite vectors, or the error that names them.
fn finite(parts: &[(&'static str, DVec3)]) -> Result<(), ConstructError> {
    match parts.iter().find(|(_, v)| !v.is_finite()) {
        Some((what, _)) => Err(ConstructError::NotFinite { what }),
        None => Ok(()),
    }
}

/// No plane between the vectors, or one of them zero.
fn on_one_line(x: DVec3, y: DVec3) -> bool {
    x.cross(y).length() <= 1e-12 * x.length() * y.length()
}

/// An increasing range of parameters.
fn range(what: &'static str, a: f64, b: f64) -> Result<(), ConstructError> {
    let good = a.is_finite() && b.is_finite() && b > a;
    if good { Ok(()) } else { Err(ConstructError::Range { what, value: b - a, must: "positive and finite" }) }
}

/// The straight line from `a` to `b` over `[0, 1]`.
///
/// # Errors
/// Points that are not finite, or one point twice.
pub fn line(a: DVec3, b: DVec3) -> Result<BSpline<DVec4>, ConstructError> {
    finite(&[("the line's start", a), ("the line's end", b)])?;
    if a == b {
        return Err(ConstructError::ZeroLength { what: "the line" });
    }
    Ok(BSpline::from_bezier(Bezier::line(a, b), 0.0, 1.0)?)
}

/// `centre + cos t x + sin t y` for `t` from `from` to `to`, radians, at most 1024 turns: a circle where `x` and `y`
/// are of one length and at right angles, else an ellipse with these conjugate radii.
///
/// The domain is `[from, to]`; at the knots, at most a quarter turn apart, the parameter is the angle. Whole turns
/// close bit for bit. Accuracy: rounding, below `1e-14` of the radius (plus of the centre's coordinates).
///
/// # Errors
/// Numbers that are not finite, radii on one line, an empty or endless range.
pub fn ellipse(centre: DVec3, x: DVec3, y: DVec3, from: f64, to: f64) -> Result<BSpline<DVec4>, ConstructError> {
    finite(&[("the centre", centre), ("the first radius", x), ("the second radius", y)])?;
    range("the angle of the arc", from, to)?;
    if on_one_line(x, y) {
        return Err(ConstructError::ZeroLength { what: "a radius, or both are on one line: the ellipse" });
    }
    if to - from > MOST_TURNS * TAU * (1.0 + 1e-12) {
        return Err(ConstructError::Range {
            what: "the angle of the arc",
            value: to - from,
            must: "at most 1024 turns",
        });
    }
    let mut spans: Vec<Span<Bezier<DVec4>>> = pieces(from, to, FRAC_PI_2)
        .windows(2)
        .map(|k| Span { start: k[0], end: k[1], piece: arc(centre, x, y, k[0], k[1]) })
        .collect();
    let turns = (to - from) / TAU;
    if (turns - turns.round()).abs() <= 1e-12 {
        let (first, last) = (spans[0].piece.points[0], spans.len() - 1);
        spans[last].piece.points[2] = first;
    }
    joined(&spans)
}

/// The circle of `radius` about `centre` in the plane across `axis`, from the direction `start` on (made
/// perpendicular to the axis), by `angle` around the axis, radians. See [`ellipse`].
///
/// # Errors
/// As [`ellipse`]; a radius that is not positive; a start along the axis.
pub fn circle(
    centre: DVec3,
    axis: DVec3,
    start: DVec3,
    radius: f64,
    angle: f64,
) -> Result<BSpline<DVec4>, ConstructError> {
    finite(&[("the axis", axis), ("the start", start)])?;
    if !(radius > 0.0 && radius.is_finite()) {
        return Err(ConstructError::Range { what: "the radius", value: radius, must: "positive" });
    }
    let z = axis.try_normalize().ok_or(ConstructError::ZeroLength { what: "the axis" })?;
    let across = start - z * start.dot(z);
    let direction = across.try_normalize().filter(|_| across.length() > 1e-9 * start.length());
    let x = direction.ok_or(ConstructError::ZeroLength { what: "the start, seen along the axis," })?;
    ellipse(centre, x * radius, z.cross(x) * radius, 0.0, angle)
}

/// `apex + t² x + t y` for `t` from `from` to `to`, exactly: one quadratic over `[from, to]`.
///
/// # Errors
/// Numbers that are not finite, `x` and `y` on one line, an empty range.
pub fn parabola(apex: DVec3, x: DVec3, y: DVec3, from: f64, to: f64) -> Result<BSpline<DVec4>, ConstructError> {
    finite(&[("the apex", apex), ("the parabola's axis", x), ("the parabola's tangent", y)])?;
    range("the range of the parabola", from, to)?;
    if on_one_line(x, y) {
        return Err(ConstructError::ZeroLength { what: "the parabola's axis or tangent, or both are on one line: it" });
    }
    // the polar form: t² becomes the product of two parameters, t their mean
    let polar = |a: f64, b: f64| DVec4::from_point(apex + x * (a * b) + y * (0.5 * (a + b)), 1.0);
    let points = vec![polar(from, from), polar(from, to), polar(to, to)];
    Ok(BSpline::from_bezier(Bezier { points }, from, to)?)
}

/// `centre + cosh t x + sinh t y` for `t` from `from` to `to`, between -300 and 300.
///
/// At the knots, at most 2 apart, the parameter is `t`. Accuracy: rounding of the largest coordinate.
///
/// # Errors
/// Numbers that are not finite, `x` and `y` on one line, an empty range or one beyond 300.
pub fn hyperbola(centre: DVec3, x: DVec3, y: DVec3, from: f64, to: f64) -> Result<BSpline<DVec4>, ConstructError> {
    /// The coordinates' products overflow for larger `cosh`.
    const FARTHEST: f64 = 300.0;
    finite(&[("the centre", centre), ("the hyperbola's axis", x), ("the hyperbola's tangent", y)])?;
    range("the range of the hyperbola", from, to)?;
    if on_one_line(x, y) {
        return Err(ConstructError::ZeroLength {
            what: "the hyperbola's axis or tangent, or both are on one line: it",
        });
    }
    let far = from.abs().max(to.abs());
    if far > FARTHEST {
        return Err(ConstructError::Range { what: "the range of the hyperbola", value: far, must: "at most 300" });
    }
    let at = |t: f64, weight: f64| (centre * weight + x * t.cosh() + y * t.sinh()).extend(weight);
    let span = |k: &[f64]| {
        let (middle, half) = (0.5 * (k[0] + k[1]), 0.5 * (k[1] - k[0]));
        let points = vec![at(k[0], 1.0), at(middle, half.cosh()), at(k[1], 1.0)];
        Span { start: k[0], end: k[1], piece: Bezier { points } }
    };
    joined(&pieces(from, to, 2.0).windows(2).map(span).collect::<Vec<_>>())
}

fn joined(spans: &[Span<Bezier<DVec4>>]) -> Result<BSpline<DVec4>, ConstructError> {
    let (degree, knots, points) = assemble(spans);
    Ok(BSpline::new(degree, knots, points)?)
}

/// Bézier segments of one degree end to end: segment `i` has the control points `points[i * degree ..= (i + 1) *
/// degree]`, so neighbours share one, and the parameters `[i, i + 1]`.
///
/// Homogeneous control points, in the plane or in space.
///
/// # Errors
/// A number of points that is not a multiple of the degree and one more; errors of [`BSpline::new`].
pub fn chain<P: Control>(degree: usize, points: Vec<P>) -> Result<BSpline<P>, ConstructError> {
    let segments = points.len().saturating_sub(1) / degree.max(1);
    if degree == 0 || segments == 0 || segments * degree + 1 != points.len() {
        return Err(ConstructError::Count {
            what: "control points",
            got: points.len(),
            needed: segments.max(1) * degree + 1,
        });
    }
    let knots = (0..=segments).flat_map(|i| {
        let end = i == 0 || i == segments;
        std::iter::repeat_n(i as f64, degree + usize::from(end))
    });
    Ok(BSpline::new(degree, knots.collect(), points)?)
}

/// How parameters are given to points.
#[derive(Clone, Debug, PartialEq)]
pub enum Parameters {
    /// 0, 1, 2, …
    Uniform,
    /// Differences are distances: the spline runs at about unit speed.
    ChordLength,
    /// Differences are square roots of distances: smoother where distances vary much.
    Centripetal,
    /// Given, increasing.
    Given(Vec<f64>),
}

impl Parameters {
    /// One parameter a point. Closed curves carry their first point again at the end.
    ///
    /// # Errors
    /// Neighbours that coincide, by index; given parameters that do not increase or do not fit.
    pub fn of(&self, points: &[DVec3]) -> Result<Vec<f64>, ConstructError> {
        if points.iter().any(|p| !p.is_finite()) {
            return Err(ConstructError::NotFinite { what: "a point" });
        }
        let size = points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max);
        let mut at = 0.0;
        let mut sums = |power: f64| {
            let mut all = vec![0.0];
            for (i, w) in points.windows(2).enumerate() {
                let distance = w[0].distance(w[1]);
                if distance <= SAME * size {
                    return Err(ConstructError::CoincidentPoints { first: i, second: i + 1 });
                }
                at += distance.powf(power);
                all.push(at);
            }
            Ok(all)
        };
        match self {
            Self::Uniform => Ok((0..points.len()).map(|i| i as f64).collect()),
            Self::ChordLength => sums(1.0),
            Self::Centripetal => sums(0.5),
            Self::Given(given) => {
                if given.len() != points.len() {
                    return Err(ConstructError::Count { what: "parameters", got: given.len(), needed: points.len() });
                }
                let good = |i: usize| given[i].is_finite() && (i == 0 || given[i] > given[i - 1]);
                match (0..given.len()).find(|i| !good(*i)) {
                    Some(index) => Err(ConstructError::Order { what: "parameter", index }),
                    None => Ok(given.clone()),
                }
            }
        }
    }
}

/// Where an interpolating curve ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum CurveEnds {
    /// No bending at the ends.
    Natural,
    /// One cubic over the first two spans, and over the last two.
    NotAKnot,
    /// These first derivatives, in units of the parameters.
    Clamped(DVec3, DVec3),
    /// Closed, with two continuous derivatives; the first point is not repeated at the end of the list.
    Closed,
}

/// The C² cubic spline through `points`; the end points (and the seam of a closed curve) are met bit for bit.
///
/// # Errors
/// Fewer than 2 points (closed: 3), a point that is not finite, neighbours that coincide, parameters that do not fit
/// (for [`CurveEnds::Closed`] they have one more than there are points: the parameter of the first point's return).
pub fn interpolate(
    points: &[DVec3],
    parameters: &Parameters,
    ends: CurveEnds,
) -> Result<BSpline<DVec4>, ConstructError> {
    let closed = ends == CurveEnds::Closed;
    let needed = if closed { 3 } else { 2 };
    if points.len() < needed {
        return Err(ConstructError::TooFew { what: "points", got: points.len(), needed });
    }
    if points.len() > MOST_POINTS {
        return Err(ConstructError::TooMany { what: "points", got: points.len(), most: MOST_POINTS });
    }
    if points.iter().any(|p| !p.is_finite()) {
        return Err(ConstructError::NotFinite { what: "a point" });
    }
    let mut values = points.to_vec();
    values.extend(closed.then_some(points[0]));
    let (kind, slopes) = match ends {
        CurveEnds::Natural => (Ends::Natural, None),
        CurveEnds::NotAKnot => (Ends::NotAKnot, None),
        CurveEnds::Clamped(a, b) => (Ends::Clamped, Some((a, b))),
        CurveEnds::Closed => (Ends::Periodic, None),
    };
    let slopes = slopes.unwrap_or((DVec3::ZERO, DVec3::ZERO));
    finite(&[("the first end's derivative", slopes.0), ("the last end's derivative", slopes.1)])?;
    let cubic = Cubic::new(&parameters.of(&values)?, kind)?;
    let control = cubic.control(&values, slopes);
    let points = control.iter().map(|p| p.extend(1.0)).collect();
    Ok(BSpline::new(cubic.degree(), cubic.knots().to_vec(), points)?)
}
