//! B-spline curves, and the checks that every knot vector passes.

use super::spare::{spare, without};
use super::{Bezier, Control, MAX_DEGREE, Span};
#[cfg(feature = "serde")]
use serde::Deserialize;

/// Why a spline is invalid.
#[allow(missing_docs)] // the messages say what each field is
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SplineError {
    /// Degree 0, or above [`MAX_DEGREE`].
    #[error("degree {0} is not between 1 and {MAX_DEGREE}")]
    Degree(usize),
    /// `knots = points + degree + 1` does not hold.
    #[error("{knots} knots do not fit {points} control points of degree {degree}")]
    KnotCount { knots: usize, points: usize, degree: usize },
    /// The control net of a surface does not have the size that its knots require.
    #[error("{points} control points do not make a net of {count_u} by {count_v}")]
    NetSize { points: usize, count_u: usize, count_v: usize },
    /// Fewer control points than the degree needs.
    #[error("{points} control points are too few for degree {degree}")]
    TooFewPoints { points: usize, degree: usize },
    /// A knot below its predecessor, or not finite.
    #[error("knot {index} is smaller than the one before it, or not a number")]
    KnotOrder { index: usize },
    /// An interior knot repeated more than `degree` times: the curve would break.
    #[error("knot {value} has multiplicity {multiplicity}, more than the degree {degree}")]
    Multiplicity { value: f64, multiplicity: usize, degree: usize },
    /// First and last knot of the domain coincide.
    #[error("the parameter domain is empty")]
    EmptyDomain,
    /// A coordinate or weight that is not finite, or a weight that is not positive.
    #[error("control point {index} has a coordinate that is not finite or a weight that is not positive")]
    ControlPoint { index: usize },
}

/// A rational B-spline curve: of [`DVec3`](glam::DVec3) in the plane, of [`DVec4`](glam::DVec4) in space. Control
/// points are homogeneous, the weight last.
///
/// Invariants, established by [`BSpline::new`]: `knots.len() == points.len() + degree + 1`, knots
/// non-decreasing and finite, interior multiplicity at most the degree, weights positive.
#[derive(Clone, Debug, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
#[cfg_attr(feature = "serde", serde(try_from = "BSplineData<P>", bound(deserialize = "P: Control + Deserialize<'de>")))]
pub struct BSpline<P> {
    pub(super) degree: usize,
    pub(super) knots: Vec<f64>,
    pub(super) points: Vec<P>,
}

/// The stored form of a [`BSpline`], before it is checked.
#[cfg(feature = "serde")]
#[derive(Deserialize)]
struct BSplineData<P> {
    degree: usize,
    knots: Vec<f64>,
    points: Vec<P>,
}

#[cfg(feature = "serde")]
impl<P: Control> TryFrom<BSplineData<P>> for BSpline<P> {
    type Error = SplineError;

    fn try_from(data: BSplineData<P>) -> Result<Self, SplineError> {
        Self::new(data.degree, data.knots, data.points)
    }
}

impl<P: Control> BSpline<P> {
    /// Checks the invariants. A knot inside the domain whose multiplicity exceeds the degree is reduced to the degree,
    /// where the control points show that the curve is one piece.
    ///
    /// # Errors
    /// The first of [`SplineError`] that does not hold.
    pub fn new(degree: usize, knots: Vec<f64>, points: Vec<P>) -> Result<Self, SplineError> {
        let same = |i: usize, j: usize| i < points.len() && j < points.len() && points[i] == points[j];
        let spare = spare(degree, &knots, same);
        if !spare.is_empty() && knots.len() - degree - 1 == points.len() {
            return Self::new(degree, without(&knots, &spare), without(&points, &spare));
        }
        check_knots(degree, &knots, points.len())?;
        check_points(&points)?;
        Ok(Self { degree, knots, points })
    }

    /// As [`BSpline::new`]; a curve that is torn at knots inside its domain comes as its pieces, in order.
    ///
    /// # Errors
    /// As [`BSpline::new`].
    pub fn pieces(degree: usize, knots: Vec<f64>, points: Vec<P>) -> Result<Vec<Self>, SplineError> {
        match Self::new(degree, knots.clone(), points.clone()) {
            Err(SplineError::Multiplicity { value, .. }) => {
                let first = knots.partition_point(|k| *k < value);
                let last = knots.partition_point(|k| *k <= value);
                let behind = last - degree - 1;
                let before = (knots[..first + degree + 1].to_vec(), points[..first].to_vec());
                let mut all = Self::pieces(degree, before.0, before.1)?;
                all.extend(Self::pieces(degree, knots[behind..].to_vec(), points[behind..].to_vec())?);
                Ok(all)
            }
            other => other.map(|whole| vec![whole]),
        }
    }

    /// One Bézier segment over `[start, end]`.
    pub fn from_bezier(bezier: Bezier<P>, start: f64, end: f64) -> Result<Self, SplineError> {
        let n = bezier.points.len();
        let knots = [start].repeat(n).into_iter().chain([end].repeat(n)).collect();
        Self::new(n - 1, knots, bezier.points)
    }

    /// Polynomial degree.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The knot vector, `points + degree + 1` long.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Homogeneous control points.
    pub fn points(&self) -> &[P] {
        &self.points
    }

    /// The parameter interval.
    pub fn domain(&self) -> (f64, f64) {
        (self.knots[self.degree], self.knots[self.points.len()])
    }

    /// All weights equal: a polynomial curve.
    pub fn is_polynomial(&self) -> bool {
        let w = self.points[0].weight();
        self.points.iter().all(|p| (p.weight() - w).abs() <= 1e-14 * w.abs())
    }

    /// Homogeneous value at `t`, clamped to the domain.
    pub fn homogeneous(&self, t: f64) -> P {
        let (a, b) = self.domain();
        let t = t.clamp(a, b);
        let k = find_span(self.degree, &self.knots, self.points.len(), t);
        de_boor(self.degree, &self.knots, k, t, &self.points[k - self.degree..=k])
    }

    /// Point at `t`, clamped to the domain.
    pub fn point(&self, t: f64) -> P::Point {
        self.homogeneous(t).point()
    }

    /// The Bézier pieces, in order; spans of zero length are dropped.
    pub fn beziers(&self) -> Vec<Span<Bezier<P>>> {
        to_beziers(self.degree, &self.knots, &self.points)
            .into_iter()
            .map(|s| Span { start: s.start, end: s.end, piece: Bezier { points: s.piece } })
            .collect()
    }

    /// The piece over `[a, b]` (inside the domain) as Bézier segments.
    pub fn beziers_between(&self, a: f64, b: f64) -> Vec<Span<Bezier<P>>> {
        self.beziers()
            .into_iter()
            .filter(|s| s.end > a && s.start < b)
            .map(|s| {
                let (lo, hi) = (a.max(s.start), b.min(s.end));
                let len = s.end - s.start;
                let piece = s.piece.segment((lo - s.start) / len, (hi - s.start) / len);
                Span { start: lo, end: hi, piece }
            })
            .collect()
    }

    /// The same curve run backwards over the same domain, bit for bit.
    pub fn reversed(&self) -> Self {
        let (a, b) = self.domain();
        let mirrored = |&k: &f64| {
            if k <= a {
                b + (a - k)
            } else if k >= b {
                a - (k - b)
            } else {
                (a + (b - k)).clamp(a, b) // rounding must not reorder knots
            }
        };
        Self {
            degree: self.degree,
            knots: self.knots.iter().rev().map(mirrored).collect(),
            points: self.points.iter().rev().copied().collect(),
        }
    }
}

/// Degree, length, order, finiteness, multiplicity and domain of one knot vector.
pub(super) fn check_knots(degree: usize, knots: &[f64], points: usize) -> Result<(), SplineError> {
    if degree == 0 || degree > MAX_DEGREE {
        return Err(SplineError::Degree(degree));
    }
    if points <= degree {
        return Err(SplineError::TooFewPoints { points, degree });
    }
    if knots.len() != points + degree + 1 {
        return Err(SplineError::KnotCount { knots: knots.len(), points, degree });
    }
    if !knots[0].is_finite() {
        return Err(SplineError::KnotOrder { index: 0 });
    }
    if let Some(i) = (1..knots.len()).find(|&i| !(knots[i].is_finite() && knots[i] >= knots[i - 1])) {
        return Err(SplineError::KnotOrder { index: i });
    }
    let (a, b) = (knots[degree], knots[points]);
    if a >= b {
        return Err(SplineError::EmptyDomain);
    }
    let inside = &knots[degree + 1..points];
    for run in inside.chunk_by(|x, y| x == y) {
        if run.len() > degree && run[0] > a && run[0] < b {
            return Err(SplineError::Multiplicity { value: run[0], multiplicity: run.len(), degree });
        }
    }
    Ok(())
}

/// Finite coordinates and positive weights.
pub(super) fn check_points<P: Control>(points: &[P]) -> Result<(), SplineError> {
    match points.iter().position(|p| !p.finite() || p.weight() <= 0.0) {
        Some(index) => Err(SplineError::ControlPoint { index }),
        None => Ok(()),
    }
}

/// Index `k` with `knots[k] <= t < knots[k + 1]`; the last non-empty span at the end of the domain.
pub(super) fn find_span(degree: usize, knots: &[f64], points: usize, t: f64) -> usize {
    let inside = &knots[degree..=points];
    let after = inside.partition_point(|&k| k <= t);
    let mut k = degree + after.saturating_sub(1);
    while k > degree && (k >= points || knots[k] == knots[k + 1]) {
        k -= 1;
    }
    k
}

/// de Boor's algorithm on the `degree + 1` control points that act on span `k`.
fn de_boor<P: Control>(degree: usize, knots: &[f64], k: usize, t: f64, points: &[P]) -> P {
    let mut d = [P::ZERO; MAX_DEGREE + 1];
    d[..=degree].copy_from_slice(points);
    for r in 1..=degree {
        for j in (r..=degree).rev() {
            let lo = knots[j + k - degree];
            let hi = knots[j + 1 + k - r];
            let a = (t - lo) / (hi - lo);
            d[j] = d[j - 1] * (1.0 - a) + d[j] * a;
        }
    }
    d[degree]
}

/// The Bézier pieces of one knot vector applied to one row of control points: see [`Cuts`].
fn to_beziers<P: Control>(degree: usize, knots: &[f64], points: &[P]) -> Vec<Span<Vec<P>>> {
    let cuts = Cuts::new(degree, knots, points.len());
    let mut flat = Vec::new();
    cuts.apply(points, &mut flat);
    let pieces = flat.chunks_exact(degree + 1).map(<[P]>::to_vec);
    cuts.ranges().zip(pieces).map(|((start, end), piece)| Span { start, end, piece }).collect()
}

/// The spans of one knot vector, made ready to cut rows of control points into Bézier pieces.
///
/// Each piece is found by *blossoming*: control point `i` of the piece over `[a, b]` is the polar value at `degree - i`
/// copies of `a` and `i` copies of `b`. Neighbouring pieces share their end control point bit for bit: the later piece
/// takes the earlier one's. The mixing weights depend on the knots alone, and the rounds with `a` are shared by all
/// points of a piece.
#[derive(Clone, Debug)]
pub(super) struct Cuts {
    degree: usize,
    spans: Vec<Cut>,
    /// The part of the later of two neighbours at the start and at the end of each span: round by round, the last
    /// pair first.
    parts: Vec<[f64; 2]>,
}

/// A span that is not empty.
#[derive(Clone, Debug)]
struct Cut {
    /// Knot at its start.
    knot: usize,
    range: (f64, f64),
}

impl Cuts {
    /// `points`: how many control points a row has.
    pub fn new(degree: usize, knots: &[f64], points: usize) -> Self {
        let filled = (degree..points).filter(|&k| knots[k] < knots[k + 1]);
        let spans: Vec<Cut> = filled.map(|knot| Cut { knot, range: (knots[knot], knots[knot + 1]) }).collect();
        let mut parts = Vec::with_capacity(spans.len() * pairs(degree));
        for Cut { knot, range: (a, b) } in &spans {
            for round in 1..=degree {
                for j in (round..=degree).rev() {
                    let (lo, hi) = (knots[j + knot - degree], knots[j + 1 + knot - round]);
                    parts.push([(a - lo) / (hi - lo), (b - lo) / (hi - lo)]);
                }
            }
        }
        Self { degree, spans, parts }
    }

    /// The parameter ranges of the pieces.
    pub fn ranges(&self) -> impl Iterator<Item = (f64, f64)> {
        self.spans.iter().map(|s| s.range)
    }

    /// Number of pieces.
    pub fn count(&self) -> usize {
        self.spans.len()
    }

    /// Appends `degree + 1` points a piece.
    pub fn apply<P: Control>(&self, points: &[P], out: &mut Vec<P>) {
        // the same for every degree; where that is known beforehand, points stay in registers
        match self.degree {
            1 => self.apply_known::<P, 2>(points, out),
            2 => self.apply_known::<P, 3>(points, out),
            3 => self.apply_known::<P, 4>(points, out),
            4 => self.apply_known::<P, 5>(points, out),
            5 => self.apply_known::<P, 6>(points, out),
            _ => self.apply_known::<P, { MAX_DEGREE + 1 }>(points, out),
        }
    }

    /// `N`: at least the number of points of a piece.
    fn apply_known<P: Control, const N: usize>(&self, points: &[P], out: &mut Vec<P>) {
        let count = if N <= MAX_DEGREE { N } else { self.degree + 1 };
        let degree = count - 1;
        let first = out.len();
        out.reserve(self.spans.len() * count);
        let mut early = [P::ZERO; N]; // rounds with the start so far
        for (cut, own) in self.spans.iter().zip(self.parts.chunks_exact(pairs(degree))) {
            let from = out.len();
            out.resize(from + count, P::ZERO);
            let piece = &mut out[from..from + count];
            early[..count].copy_from_slice(&points[cut.knot - degree..=cut.knot]);
            let mut parts = own;
            for round in 1..=count {
                let mut late = early; // this point and the later ones of the piece have no more than these
                let mut rest = parts;
                for r in round..count {
                    rest = mix(&mut late[..count], r, rest, 1);
                }
                piece[count - round] = late[degree];
                if round < count {
                    parts = mix(&mut early[..count], round, parts, 0);
                }
            }
            if from > first {
                out[from] = out[from - 1];
            }
        }
    }
}

/// Neighbours mixed in all rounds of a span.
fn pairs(degree: usize) -> usize {
    degree * (degree + 1) / 2
}

/// One round of a blossom; returns the parts of the rounds after it.
#[inline(always)]
fn mix<'a, P: Control>(d: &mut [P], round: usize, parts: &'a [[f64; 2]], end: usize) -> &'a [[f64; 2]] {
    let (own, rest) = parts.split_at(d.len() - round);
    for (j, part) in (round..d.len()).rev().zip(own) {
        let f = part[end];
        d[j] = if f == 0.0 {
            d[j - 1]
        } else if f == 1.0 {
            d[j]
        } else {
            d[j - 1] * (1.0 - f) + d[j] * f
        };
    }
    rest
}
