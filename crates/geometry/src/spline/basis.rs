//! Values and derivatives of the B-splines that are not zero at one parameter.
//!
//! ```text
//!            N_k-p      …      N_k          p + 1 of them, for knots[k] <= t < knots[k + 1]
//!          ╱──────╲╱──────╲╱──────╲
//!        ─┴────┴────┴─•──┴────┴────┴─▶ t
//!               knots[k]  knots[k + 1]
//! ```
//!
//! Source: L. Piegl, W. Tiller, *The NURBS Book*, 1997, algorithms A2.2 and A2.3; derivatives here by the recurrence
//! (2.9), which costs little more for two derivatives.

use super::MAX_DEGREE;
use super::bspline::find_span;

/// The B-splines at one parameter.
#[derive(Clone, Copy, Debug)]
pub struct Basis {
    /// Index of the first control point that acts here.
    pub first: usize,
    degree: usize,
    values: [[f64; MAX_DEGREE + 1]; 3],
}

impl Basis {
    /// At `t`, clamped to the domain, with derivatives of order 1 and 2. At the end of a span the
    /// derivatives are those of the span after it, at the end of the domain those of the last.
    ///
    /// `points` control points make the knot vector `points + degree + 1` long.
    pub fn new(degree: usize, knots: &[f64], points: usize, t: f64) -> Self {
        let t = t.clamp(knots[degree], knots[points]);
        let k = find_span(degree, knots, points, t);
        let mut values = [[0.0; MAX_DEGREE + 1]; 3];
        // row p: the B-splines of degree p, N_{k-p} .. N_k, at index 0 ..= p
        let mut rows = [[0.0; MAX_DEGREE + 1]; MAX_DEGREE + 1];
        rows[0][0] = 1.0;
        for p in 1..=degree {
            for r in 0..p {
                let (lo, hi) = (knots[k + 1 + r - p], knots[k + 1 + r]);
                let share = rows[p - 1][r] / (hi - lo);
                rows[p][r] += (hi - t) * share;
                rows[p][r + 1] += (t - lo) * share;
            }
        }
        values[0] = rows[degree];
        // N'_{i,p} = p (N_{i,p-1} / (t_{i+p} - t_i) - N_{i+1,p-1} / (t_{i+p+1} - t_{i+1}))
        let raise = |from: &[f64; MAX_DEGREE + 1], p: usize| {
            let mut out = [0.0; MAX_DEGREE + 1];
            for r in 0..p {
                let (lo, hi) = (knots[k + 1 + r - p], knots[k + 1 + r]);
                let share = p as f64 * from[r] / (hi - lo);
                out[r] -= share;
                out[r + 1] += share;
            }
            out
        };
        values[1] = raise(&rows[degree - 1], degree);
        if degree > 1 {
            values[2] = raise(&raise(&rows[degree - 2], degree - 1), degree);
        }
        Self { first: k - degree, degree, values }
    }

    /// Derivatives of `order` 0, 1 or 2 of the `degree + 1` B-splines from [`Basis::first`].
    pub fn derivatives(&self, order: usize) -> &[f64] {
        &self.values[order][..=self.degree]
    }

    /// The B-splines' values.
    pub fn values(&self) -> &[f64] {
        self.derivatives(0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// On one Bézier span the B-splines are the Bernstein polynomials.
    #[test]
    fn cubic_bernstein() {
        let knots = [0.0, 0.0, 0.0, 0.0, 1.0, 1.0, 1.0, 1.0];
        for t in [0.0, 0.25, 0.5, 1.0] {
            let s = 1.0 - t;
            let b = Basis::new(3, &knots, 4, t);
            let expected: [[f64; 4]; 3] = [
                [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t],
                [-3.0 * s * s, 3.0 * s * s - 6.0 * s * t, 6.0 * s * t - 3.0 * t * t, 3.0 * t * t],
                [6.0 * s, 6.0 * t - 12.0 * s, 6.0 * s - 12.0 * t, 6.0 * t],
            ];
            for (order, row) in expected.iter().enumerate() {
                for (x, y) in b.derivatives(order).iter().zip(row) {
                    assert!((x - y).abs() < 1e-14, "order {order} at {t}");
                }
            }
        }
    }

    /// `sum N_i ξ_i = t` with the Greville abscissae, so the first derivatives sum to 1 and the second to 0.
    #[test]
    fn reproduces_the_parameter() {
        let knots = [0.0, 0.0, 0.0, 0.5, 0.7, 0.7, 2.0, 3.0, 3.0, 3.0];
        for degree in [2] {
            let points = knots.len() - degree - 1;
            let greville = |i: usize| knots[i + 1..=i + degree].iter().sum::<f64>() / degree as f64;
            for step in 0..=60 {
                let t = f64::from(step) * 0.05;
                let b = Basis::new(degree, &knots, points, t);
                let sum = |order| {
                    b.derivatives(order).iter().enumerate().map(|(r, x)| x * greville(b.first + r)).sum::<f64>()
                };
                assert!((sum(0) - t.min(3.0)).abs() < 1e-14);
                assert!((sum(1) - 1.0).abs() < 1e-13);
                assert!(sum(2).abs() < 1e-12);
            }
        }
    }
}
