//! The bases of free-form statements, converted exactly to B-spline control points.
//!
//! ```text
//!   control points   c0 c1 c2 c3 c4 c5 c6           parm  t0 t1 t2
//!   bezier, n = 3    └────┬───┘                           └──┴── each segment n + 1 points,
//!                             └────┬───┘                         the next `step` points farther
//!   cardinal         └────┬───┘ step 1      taylor  └────┬───┘ step n + 1      bmatrix: any step
//!   bspline          its own knots are the parm values
//! ```
//!
//! A segment of basis matrix `b` is `sum_i c_i sum_j b_ij t^j` over `t` in `[0, 1]`, so its power
//! coefficients are `a_j = sum_i b_ij c_i` and its Bézier points `sum_j (k over j) / (n over j) a_j`
//! (Farin 2002, 5.8). Segments become one B-spline whose inner knots have multiplicity `n`, so they must
//! meet; they do up to rounding in every basis of a continuous curve.
//!
//! Source: Alias|Wavefront, *Advanced Visualizer Manual*, appendix B1, "Basis functions", 1990s.

use crate::spline::{Control, MAX_DEGREE, binomial};

/// A basis, by the name after `cstype`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Basis {
    Bezier,
    BSpline,
    Cardinal,
    Taylor,
    Matrix,
}

impl Basis {
    /// The basis of that name.
    pub fn named(name: &str) -> Option<Self> {
        let all = [
            ("bezier", Self::Bezier),
            ("bspline", Self::BSpline),
            ("cardinal", Self::Cardinal),
            ("taylor", Self::Taylor),
            ("bmatrix", Self::Matrix),
        ];
        all.iter().find(|(n, _)| *n == name).map(|(_, basis)| *basis)
    }
}

/// One parameter direction of a curve or surface.
pub(super) struct Axis {
    /// Degree of the B-spline.
    pub degree: usize,
    /// Its knots.
    pub knots: Vec<f64>,
    /// Control points in the file.
    pub count: usize,
    /// Points from one segment to the next, and the matrix to Bézier points, a row each.
    segments: Option<(usize, Vec<f64>)>,
}

/// Ends of segments are one point when no coordinate differs by more than this part of the largest.
const JOIN: f64 = 1e-9;

impl Axis {
    /// The direction that the statements describe: `step` and `matrix` are those of `bmatrix`.
    pub fn new(basis: Basis, degree: usize, step: usize, matrix: &[f64], parm: &[f64]) -> Result<Self, String> {
        if degree == 0 || degree > MAX_DEGREE {
            return Err(format!("degree {degree} is not between 1 and {MAX_DEGREE}"));
        }
        if parm.len() < 2 {
            return Err("fewer than two parameter values".into());
        }
        if basis == Basis::BSpline {
            let count = parm.len().saturating_sub(degree + 1);
            if count <= degree {
                return Err("too few knots for the degree".into());
            }
            return Ok(Self { degree, knots: parm.to_vec(), count, segments: None });
        }
        let n = degree;
        let (step, to_bezier) = match basis {
            Basis::Cardinal if degree != 3 => return Err("a cardinal spline that is not cubic".into()),
            Basis::Cardinal => {
                let s = 1.0 / 6.0;
                (1, vec![0., 1., 0., 0., -s, 1., s, 0., 0., s, 1., -s, 0., 0., 1., 0.])
            }
            Basis::Taylor => (n + 1, from_power(n, |i, j| f64::from(u8::from(i == j)))),
            Basis::Matrix => {
                if matrix.len() != (n + 1) * (n + 1) {
                    return Err(format!("a basis matrix of {} numbers for degree {n}", matrix.len()));
                }
                if step == 0 || step > n + 1 {
                    return Err(format!("step {step} is not between 1 and {}", n + 1));
                }
                (step, from_power(n, |i, j| matrix[i * (n + 1) + j]))
            }
            Basis::Bezier | Basis::BSpline => (n, from_identity(n)),
        };
        let segments = parm.len() - 1;
        let inner = parm[1..segments].iter().flat_map(|&t| [t].repeat(n));
        let knots = [parm[0]].repeat(n + 1).into_iter().chain(inner).chain([parm[segments]].repeat(n + 1)).collect();
        Ok(Self { degree, knots, count: step * (segments - 1) + n + 1, segments: Some((step, to_bezier)) })
    }

    /// Control points of the B-spline, for as many points as [`Axis::count`] says.
    pub fn apply<P: Control>(&self, points: &[P]) -> Result<Vec<P>, String> {
        let Some((step, matrix)) = &self.segments else { return Ok(points.to_vec()) };
        let n = self.degree;
        let mut all: Vec<P> = Vec::new();
        for segment in (0..).map(|k| k * step).take_while(|at| at + n < points.len()) {
            let local = &points[segment..=segment + n];
            let bezier = matrix.chunks_exact(n + 1).map(|row| {
                let terms = row.iter().zip(local).filter(|(m, _)| **m != 0.0);
                // a lone point is not multiplied, so that Bézier input keeps its bits
                terms.fold(P::ZERO, |sum, (&m, &p)| if m == 1.0 { sum + p } else { sum + p * m })
            });
            let mut bezier = bezier.peekable();
            if let (Some(&before), Some(&first)) = (all.last(), bezier.peek()) {
                if (before - first).max_abs() > JOIN * before.max_abs().max(first.max_abs()) {
                    return Err("segments that do not meet".into());
                }
                bezier.next();
            }
            all.extend(bezier);
        }
        Ok(all)
    }

    /// Control points of the B-spline in this direction.
    pub fn output(&self) -> usize {
        self.knots.len() - self.degree - 1
    }
}

/// Rows of Bézier points from a basis matrix `b(i, j)`: control point `i`, power `j`.
fn from_power(n: usize, b: impl Fn(usize, usize) -> f64) -> Vec<f64> {
    let entry = |k: usize, i: usize| (0..=k).map(|j| binomial(k, j) / binomial(n, j) * b(i, j)).sum();
    (0..=n).flat_map(|k| (0..=n).map(move |i| (k, i))).map(|(k, i)| entry(k, i)).collect()
}

fn from_identity(n: usize) -> Vec<f64> {
    (0..(n + 1) * (n + 1)).map(|at| f64::from(u8::from(at % (n + 2) == 0))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::BSpline;
    use glam::DVec3;

    /// The curve of one basis over `parm`.
    fn curve(
        basis: Basis,
        degree: usize,
        step: usize,
        matrix: &[f64],
        parm: &[f64],
        points: &[DVec3],
    ) -> BSpline<DVec3> {
        let axis = Axis::new(basis, degree, step, matrix, parm).unwrap();
        assert_eq!(axis.count, points.len());
        let control = axis.apply(points).unwrap();
        assert_eq!(control.len(), axis.output());
        BSpline::new(degree, axis.knots, control).unwrap()
    }

    fn points(values: &[f64]) -> Vec<DVec3> {
        values.iter().map(|&x| DVec3::new(x, 1.0 - x * x, 1.0)).collect()
    }

    /// The power sum itself, over two segments of unequal length.
    #[test]
    fn taylor_is_its_polynomial() {
        // x = 1 + 2 t - t^2, then 2 - t + 3 t^2: both are 2 where they meet
        let c: Vec<DVec3> = [1., 2., -1., 2., -1., 3.]
            .iter()
            .zip([1., 0., 0., 1., 0., 0.])
            .map(|(&x, w)| DVec3::new(x, 2. * x, w))
            .collect();
        let spline = curve(Basis::Taylor, 2, 0, &[], &[0.0, 1.0, 5.0], &c);
        for i in 0..=20 {
            let t = f64::from(i) / 20.0;
            assert!((spline.point(t).x - (1.0 + 2.0 * t - t * t)).abs() < 1e-14);
            assert!((spline.point(1.0 + 4.0 * t).x - (2.0 - t + 3.0 * t * t)).abs() < 4e-14);
        }
    }

    /// Interpolates the inner points with slopes from their neighbours (Catmull, Rom 1974).
    #[test]
    fn cardinal_passes_its_points() {
        let c = points(&[0.0, 1.0, 3.0, 4.0, 2.0]);
        let spline = curve(Basis::Cardinal, 3, 0, &[], &[0.0, 1.0, 2.0], &c);
        for (t, i) in [(0.0, 1), (1.0, 2), (2.0, 3)] {
            assert!((spline.point(t).x - c[i].x).abs() < 1e-15 * 8.0);
        }
        // half of c3 - c1; the second derivative jumps there, so a central difference errs by about h
        let h = 1e-5;
        let slope = (spline.point(1.0 + h).x - spline.point(1.0 - h).x) / (2.0 * h);
        assert!((slope - 0.5 * (4.0 - 1.0)).abs() < 1e-4);
    }

    /// The basis matrix of uniform cubic B-splines gives what a uniform knot vector gives.
    #[test]
    fn a_matrix_of_uniform_splines() {
        #[rustfmt::skip]
        let matrix = [1., -3., 3., -1.,  4., 0., -6., 3.,  1., 3., 3., -3.,  0., 0., 0., 1.].map(|x| x / 6.0);
        let c = points(&[0.0, 1.0, 3.0, 4.0, 2.0, 7.0]);
        let by_matrix = curve(Basis::Matrix, 3, 1, &matrix, &[0.0, 1.0, 2.0, 3.0], &c);
        let knots: Vec<f64> = (-3..=6).map(f64::from).collect();
        let by_knots = curve(Basis::BSpline, 3, 0, &[], &knots, &c);
        for i in 0..=30 {
            let t = f64::from(i) / 10.0;
            assert!((by_matrix.point(t) - by_knots.point(t)).length() < 1e-13);
        }
    }

    #[test]
    fn bezier_points_keep_their_bits() {
        let c = points(&[0.1, 0.7, -0.0, 1.0 / 3.0, 5e-324]);
        let axis = Axis::new(Basis::Bezier, 2, 0, &[], &[0.0, 1.0, 2.0]).unwrap();
        assert_eq!(axis.apply(&c).unwrap(), c);
        assert_eq!(axis.knots, [0., 0., 0., 1., 1., 2., 2., 2.]);
    }

    #[test]
    fn what_is_no_basis() {
        let error = |basis, degree, step, matrix: &[f64], parm: &[f64]| {
            Axis::new(basis, degree, step, matrix, parm).err().unwrap()
        };
        assert!(error(Basis::Bezier, 0, 0, &[], &[0., 1.]).contains("degree 0"));
        assert!(error(Basis::Bezier, 16, 0, &[], &[0., 1.]).contains("degree 16"));
        assert!(error(Basis::Bezier, 3, 0, &[], &[0.]).contains("two parameter"));
        assert!(error(Basis::BSpline, 3, 0, &[], &[0., 1.]).contains("too few knots"));
        assert!(error(Basis::Cardinal, 2, 0, &[], &[0., 1.]).contains("not cubic"));
        assert!(error(Basis::Matrix, 2, 1, &[1.0], &[0., 1.]).contains("1 numbers for degree 2"));
        assert!(error(Basis::Matrix, 1, 3, &[1.0; 4], &[0., 1.]).contains("step 3"));
        let apart = Axis::new(Basis::Taylor, 1, 0, &[], &[0., 1., 2.]).unwrap();
        let c = points(&[0.0, 1.0, 5.0, 1.0]);
        assert_eq!(apart.apply(&c).unwrap_err(), "segments that do not meet");
    }
}
