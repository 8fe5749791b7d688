//! The same spline with more knots or a higher degree, exactly.
//!
//! ```text
//!   with_knots   Boehm's insertion: every new control point lies between two old ones
//!   elevated     degree p to p + 1: every knot once more
//!
//!     b*(t_1 ... t_{p+1}) = 1/(p+1) sum_i b(t_1 ... without t_i ... t_{p+1})
//! ```
//!
//! where `b` is the polar form, whose values at `p` consecutive knots are the control points. Each value needed is
//! itself read off a knot insertion, so elevation only averages too: nothing is extrapolated.
//!
//! Sources: W. Boehm, *Inserting new knots into B-spline curves*, CAD 12, 1980; H. Prautzsch, *Degree elevation of
//! B-spline curves*, CAGD 1, 1984.

use super::bspline::check_knots;
use super::{BSpline, Control, MAX_DEGREE, SplineError, Surface};
use glam::{DAffine3, DVec4};

impl<P: Control> BSpline<P> {
    /// The same curve with `new` knots (any order; outside the domain's interior they are ignored). A knot is
    /// inserted no more often than up to the multiplicity `degree`.
    pub fn with_knots(&self, new: &[f64]) -> Self {
        let (a, b) = self.domain();
        let (mut knots, mut points) = (self.knots.clone(), self.points.clone());
        for &x in new.iter().filter(|x| **x > a && **x < b) {
            if multiplicity(&knots, x) < self.degree {
                insert(self.degree, &mut knots, &mut points, x);
            }
        }
        Self { degree: self.degree, knots, points }
    }

    /// The same curve with its end knots repeated `degree + 1` times: it begins and ends at control points.
    pub fn clamped(&self) -> Self {
        let p = self.degree;
        let (a, b) = self.domain();
        let (mut knots, mut points) = (self.knots.clone(), self.points.clone());
        for x in [a, b] {
            while multiplicity(&knots, x) < p {
                insert(p, &mut knots, &mut points, x);
            }
        }
        // the control point of p copies of a begins the curve, that of p copies of b ends it
        let first = knots.partition_point(|k| *k <= a) - p;
        let last = knots.partition_point(|k| *k < b);
        let points = points[first - 1..last].to_vec();
        let inside = knots[first..last + p].iter().copied();
        Self { degree: p, knots: [a].into_iter().chain(inside).chain([b]).collect(), points }
    }

    /// The same curve over `[a, b]`; the parameter is mapped affinely, ends exactly.
    ///
    /// # Errors
    /// The range is empty or not finite, or so small that knots no longer differ.
    pub fn over(&self, a: f64, b: f64) -> Result<Self, SplineError> {
        let (lo, hi) = self.domain();
        let map = |&k: &f64| match k {
            _ if k == lo => a,
            _ if k == hi => b,
            _ => a + (b - a) * ((k - lo) / (hi - lo)),
        };
        let knots: Vec<f64> = self.knots.iter().map(map).collect();
        check_knots(self.degree, &knots, self.points.len())?;
        Ok(Self { degree: self.degree, knots, points: self.points.clone() })
    }

    /// The same curve of degree `degree`, which is not below its own; ends are clamped, the continuity at each knot
    /// stays.
    ///
    /// Cost: about `p^3` per control point and level.
    ///
    /// # Errors
    /// `degree` is above [`MAX_DEGREE`].
    pub fn elevated_to(&self, degree: usize) -> Result<Self, SplineError> {
        if degree > MAX_DEGREE {
            return Err(SplineError::Degree(degree));
        }
        let mut curve = self.clamped();
        while curve.degree < degree {
            curve = curve.elevated_once();
        }
        Ok(curve)
    }

    /// Clamped to clamped.
    fn elevated_once(&self) -> Self {
        let p = self.degree;
        let knots: Vec<f64> =
            self.knots.chunk_by(|x, y| x == y).flat_map(|run| run.iter().copied().chain([run[0]])).collect();
        let count = knots.len() - p - 2;
        let points = (0..count).map(|j| self.elevated_point(&knots[j + 1..j + p + 2])).collect();
        Self { degree: p + 1, knots, points }
    }

    /// The control point at the `p + 1` consecutive knots `at` of the elevated knot vector.
    fn elevated_point(&self, at: &[f64]) -> P {
        let p = self.degree;
        let n = at.len();
        let mut sum = P::ZERO;
        for run in at.chunk_by(|x, y| x == y) {
            // leaving out any of equal knots gives the same value
            let skip = at.partition_point(|x| *x < run[0]);
            let rest: Vec<f64> = at[..skip].iter().chain(&at[skip + 1..]).copied().collect();
            sum = sum + self.polar(&rest, p) * (run.len() as f64 / n as f64);
        }
        sum
    }

    /// The polar form at `p` sorted arguments, all of them knots.
    fn polar(&self, at: &[f64], p: usize) -> P {
        let (end, n) = (self.domain().1, self.points.len());
        if at[0] >= end {
            return self.points[n - 1];
        }
        // the polar form depends only on the control points of the spans from the first argument's to the last one's
        let first = (self.knots.partition_point(|k| *k <= at[0]) - 1).clamp(p, n - 1);
        let last = (self.knots.partition_point(|k| *k < at[p - 1]).max(1) - 1).clamp(p, n - 1);
        let (from, to) = (first.min(last) - p, first.max(last) + 1);
        let mut knots = self.knots[from..to + p + 1].to_vec();
        let mut points = self.points[from..to].to_vec();
        for run in at.chunk_by(|x, y| x == y) {
            while multiplicity(&knots, run[0]) < run.len() {
                insert(p, &mut knots, &mut points, run[0]);
            }
        }
        // the arguments end a run of equal knots, or fill it
        let copies = at.partition_point(|x| *x <= at[0]);
        let start = knots.partition_point(|k| *k <= at[0]) - copies;
        points[start - 1]
    }
}

/// How often `x` is a knot.
fn multiplicity(knots: &[f64], x: f64) -> usize {
    knots.partition_point(|k| *k <= x) - knots.partition_point(|k| *k < x)
}

/// One more knot `x`, inside the domain or at its ends, of multiplicity below the degree.
fn insert<P: Control>(degree: usize, knots: &mut Vec<f64>, points: &mut Vec<P>, x: f64) {
    let after = knots.partition_point(|k| *k <= x);
    let k = after - 1; // knots[k] <= x < knots[k + 1]
    let present = after - knots.partition_point(|t| *t < x);
    let mut fresh = points[..=k - degree].to_vec();
    for i in k - degree + 1..=k - present {
        let a = (x - knots[i]) / (knots[i + degree] - knots[i]);
        fresh.push(points[i - 1] * (1.0 - a) + points[i] * a);
    }
    fresh.extend_from_slice(&points[k - present..]);
    *points = fresh;
    knots.insert(after, x);
}

impl Surface {
    /// The rows of the control net as curves along `u`.
    pub fn rows(&self) -> Vec<BSpline<DVec4>> {
        let n = self.counts().0;
        let row = |points: &[DVec4]| BSpline {
            degree: self.degrees().0,
            knots: self.knots().0.to_vec(),
            points: points.to_vec(),
        };
        self.points().chunks(n).map(row).collect()
    }

    /// The surface whose control net has these rows; they share degree and knots.
    ///
    /// # Errors
    /// The numbers do not make a surface.
    pub fn from_rows(rows: &[BSpline<DVec4>], degree_v: usize, knots_v: Vec<f64>) -> Result<Self, SplineError> {
        let Some(first) = rows.first() else {
            return Err(SplineError::TooFewPoints { points: 0, degree: degree_v });
        };
        let points = rows.iter().flat_map(|r| r.points.iter().copied()).collect();
        Self::new((first.degree, degree_v), first.knots.clone(), knots_v, points)
    }

    /// `u` and `v` exchanged.
    pub fn transposed(&self) -> Self {
        let (nu, nv) = self.counts();
        let points = (0..nu).flat_map(|i| (0..nv).map(move |j| self.points()[j * nu + i])).collect();
        Self::with_net((self.degrees().1, self.degrees().0), (self.knots().1, self.knots().0), points)
    }

    /// The surface moved by an affine map, exactly.
    pub fn transformed(&self, by: &DAffine3) -> Self {
        let moved = |p: &DVec4| (by.matrix3 * p.truncate() + by.translation * p.w).extend(p.w);
        Self::with_net(self.degrees(), self.knots(), self.points().iter().map(moved).collect())
    }

    /// The same surface of degree `degree` along `u`, with the `new` knots: see [`BSpline::elevated_to`] and
    /// [`BSpline::with_knots`].
    ///
    /// # Errors
    /// `degree` is above [`MAX_DEGREE`].
    pub fn refined_u(&self, degree: usize, new: &[f64]) -> Result<Self, SplineError> {
        let rows = self.rows().into_iter().map(|r| Ok(r.elevated_to(degree)?.with_knots(new)));
        Self::from_rows(&rows.collect::<Result<Vec<_>, SplineError>>()?, self.degrees().1, self.knots().1.to_vec())
    }
}
