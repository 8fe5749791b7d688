//! Where a polynomial in Bernstein form changes sign.
//!
//! ```text
//!   p(t) = sum c_i B_i^n(t),  t in [0, 1]        sign variations of (c_0 … c_n):
//!
//!    c1                                            0   no root
//!    ●   c2                                        1   exactly one root
//!   ╱  ╲ ●                                         more: halve, and count again
//!  ●    ╲  ╲
//!  c0────╲──╲────▶ t                             Descartes' rule in Bernstein form: the count
//!         ╲  ●  c3                               never falls short of the number of roots.
//! ```
//!
//! Source: G. Farin, *Curves and Surfaces for CAGD*, 2002, section 4.7 (variation diminishing);
//! J. M. Lane, R. F. Riesenfeld, *Bounds on a polynomial*, BIT 21, 1981.

use super::root::bracketed;
use std::ops::{Add, Mul};

/// Halvings of `[0, 1]` before a cluster of roots counts as one: 2^-48 is 32 times the spacing of
/// `f64` parameters near 1.
const MAX_HALVINGS: u32 = 48;

/// de Casteljau's triangle at `t`: overwrites `points` with the control points of `[0, t]` and
/// returns those of `[t, 1]`. Valid for any real `t` (extrapolation included).
pub fn split<P: Copy + Add<Output = P> + Mul<f64, Output = P>>(points: &mut [P], t: f64) -> Vec<P> {
    let n = points.len();
    let mut work = points.to_vec();
    let mut right = work.clone();
    for level in 0..n {
        points[level] = work[0];
        right[n - 1 - level] = work[n - 1 - level];
        for i in 0..n - 1 - level {
            work[i] = work[i] * (1.0 - t) + work[i + 1] * t;
        }
    }
    right
}

/// Value at `t` in `[0, 1]`, by Horner's scheme in `t / (1 - t)`.
///
/// Error below `2 n` ulp of the largest coefficient.
pub fn value(coefficients: &[f64], t: f64) -> f64 {
    let n = coefficients.len() - 1;
    if n == 0 {
        return coefficients[0];
    }
    let s = 1.0 - t;
    let mut factor = 1.0;
    let mut choose = 1.0;
    let mut sum = coefficients[0] * s;
    for (i, &c) in coefficients.iter().enumerate().take(n).skip(1) {
        factor *= t;
        choose *= (n - i + 1) as f64 / i as f64;
        sum = (sum + c * (factor * choose)) * s;
    }
    sum + coefficients[n] * (factor * t)
}

/// Parameters in `[0, 1]`, ascending, where the polynomial changes sign.
///
/// `noise` holds the rounding error of each coefficient, not negative: the sign of a coefficient that does not exceed
/// its noise is unknown, and does not count. Roots without a change of sign (double roots) are left out; a stretch of
/// unknown sign between opposite signs counts as one change, at its middle. Roots are accurate to the rounding of
/// [`value`].
///
/// Cost: `O(n²)` per halving and root.
pub fn sign_changes(coefficients: &[f64], noise: &[f64]) -> Vec<f64> {
    let mut search = Search { last: 0.0, last_at: 0.0, found: Vec::new() };
    if !coefficients.is_empty() {
        search.visit(coefficients.to_vec(), noise.to_vec(), 0.0, 1.0, 0);
    }
    search.found
}

/// A walk over sub-intervals from left to right.
struct Search {
    /// Last sign met, 0 before the first.
    last: f64,
    /// Where that sign was last seen.
    last_at: f64,
    found: Vec<f64>,
}

impl Search {
    fn visit(&mut self, c: Vec<f64>, noise: Vec<f64>, a: f64, b: f64, depth: u32) {
        let known: Vec<f64> =
            c.iter().zip(&noise).filter(|(x, noise)| x.abs() > **noise).map(|(x, _)| x.signum()).collect();
        let (Some(&first), Some(&end)) = (known.first(), known.last()) else {
            return; // all noise
        };
        let variations = known.windows(2).filter(|pair| pair[0] != pair[1]).count();
        if variations > 1 && depth < MAX_HALVINGS {
            let middle = 0.5 * (a + b);
            let ((left, right), (left_noise, right_noise)) = (halves(c), halves(noise));
            self.visit(left, left_noise, a, middle, depth + 1);
            self.visit(right, right_noise, middle, b, depth + 1);
            return;
        }
        self.meet(first, a);
        if first != end {
            self.found.push(a + (b - a) * crossing(&c, first, end));
        }
        (self.last, self.last_at) = (end, b);
    }

    /// A sign seen at the start of an interval, after whatever was noise.
    fn meet(&mut self, sign: f64, at: f64) {
        if self.last != 0.0 && self.last != sign {
            self.found.push(0.5 * (self.last_at + at));
        }
    }
}

/// The one change from sign `first` to sign `end`. An end of the interval may be a root itself, of an
/// even order: there the sign is the one inside.
fn crossing(c: &[f64], first: f64, end: f64) -> f64 {
    let size = c.iter().fold(0.0, |m: f64, x| m.max(x.abs()));
    let signed = |t: f64| {
        let x = value(c, t);
        let inner = if t == 0.0 { first } else { end };
        if (t == 0.0 || t == 1.0) && x * inner <= 0.0 { inner * size } else { x }
    };
    bracketed(signed, 0.0, 1.0, f64::EPSILON * 0.5)
}

/// Coefficients over `[0, 1/2]` and `[1/2, 1]`: de Casteljau's triangle with averages.
fn halves(mut c: Vec<f64>) -> (Vec<f64>, Vec<f64>) {
    let n = c.len();
    let mut left = Vec::with_capacity(n);
    for level in 0..n {
        left.push(c[0]);
        for i in 0..n - 1 - level {
            c[i] = 0.5 * (c[i] + c[i + 1]);
        }
    }
    (left, c)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn exact(coefficients: &[f64]) -> Vec<f64> {
        sign_changes(coefficients, &vec![0.0; coefficients.len()])
    }

    /// Bernstein coefficients of the product of `(t - r)` over `roots`.
    fn from_roots(roots: &[f64]) -> Vec<f64> {
        let mut c = vec![1.0];
        for r in roots {
            let n = c.len() as f64; // the product's degree
            let share = |i: usize| i as f64 / n;
            c = (0..=c.len())
                .map(|i| {
                    let with_b0 = if i < c.len() { -r * c[i] * (1.0 - share(i)) } else { 0.0 };
                    let with_b1 = if i > 0 { (1.0 - r) * c[i - 1] * share(i) } else { 0.0 };
                    with_b0 + with_b1
                })
                .collect();
        }
        c
    }

    #[test]
    fn value_of_known_polynomials() {
        assert_eq!(value(&[7.0], 0.3), 7.0);
        assert_eq!(value(&[1.0, 3.0], 0.25), 1.5);
        let c = from_roots(&[0.25, 0.5, 0.75]);
        assert!((value(&c, 1.0) - 0.75 * 0.5 * 0.25).abs() < 1e-16);
        assert!(value(&c, 0.5).abs() < 1e-16);
    }

    #[test]
    fn a_dyadic_root_is_exact() {
        assert_eq!(exact(&[1.0, -1.0]), [0.5]);
        assert_eq!(exact(&[1.0, -3.0]), [0.25]);
    }

    #[test]
    fn double_roots_do_not_count_and_triple_roots_count_once() {
        assert_eq!(exact(&[1.0, -1.0, 1.0]), [0.0; 0]); // (1 - 2t)²
        let triple = exact(&[-1.0, 1.0, -1.0, 1.0]); // (2t - 1)³
        assert_eq!(triple.len(), 1);
        assert!((triple[0] - 0.5).abs() < 1e-5); // the cube root of the rounding
    }

    #[test]
    fn roots_at_the_ends_do_not_hide_the_one_between() {
        assert_eq!(exact(&[0.0, 1.0, -1.0, 0.0]), [0.5]); // t (1 - t) (1 - 2t)
        let found = exact(&from_roots(&[0.0, 0.0, 0.3, 1.0]));
        assert!(found.len() == 1 && (found[0] - 0.3).abs() < 1e-15, "{found:?}");
    }

    #[test]
    fn noise_hides_signs() {
        assert_eq!(sign_changes(&[1e-17, -1e-17, 1e-17], &[1e-16; 3]), [0.0; 0]);
        let middle = sign_changes(&[1.0, 1e-17, -1e-17, 1e-17, -1.0], &[1e-16; 5]);
        assert_eq!(middle.len(), 1);
        assert!((middle[0] - 0.5).abs() < 0.05, "{middle:?}");
    }

    proptest! {
        #[test]
        fn finds_all_roots(mut roots in prop::collection::vec(0.001f64..0.999, 1..7)) {
            roots.sort_by(f64::total_cmp);
            prop_assume!(roots.windows(2).all(|w| w[1] - w[0] > 0.02));
            let c = from_roots(&roots);
            let found = exact(&c);
            prop_assert_eq!(found.len(), roots.len());
            let largest = c.iter().fold(0.0f64, |m, x| m.max(x.abs()));
            for (i, (x, r)) in found.iter().zip(&roots).enumerate() {
                // rounding of the coefficients over the slope at the root
                let slope: f64 = roots.iter().enumerate().filter(|(j, _)| *j != i).map(|(_, q)| r - q).product();
                let bound = 40.0 * f64::EPSILON * largest / slope.abs() + f64::EPSILON;
                prop_assert!((x - r).abs() <= bound, "{} for {}, bound {:e}", x, r, bound);
            }
        }
    }
}
