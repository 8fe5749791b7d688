//! Where a polynomial in Bernstein form changes sign.
//!
//! ```text
//!   p(t) = sum c_i B_i^n(t),  t in [0, 1]        sign variations of (c_0 … c_n):
//!
//!    c1                                            0   no root
//!    ●   c2                                        1   exactly one root
//!   ╱  ╲ ●                                         more: halve, and ask both halves
//!  ●    ╲  ╲
//!  c0────╲──╲────▶ t                             Descartes' rule in Bernstein form: the count
//!         ╲  ●  c3                               never falls short of the number of roots.
//! ```
//!
//! Source: G. Farin, *Curves and Surfaces for CAGD*, 2002, section 4.7 (variation diminishing);
//! J. M. Lane, R. F. Riesenfeld, *Bounds on a polynomial*, BIT 21, 1981.

use super::root::bracketed;

/// Halvings of `[0, 1]` before a cluster of roots counts as one: 2^-48 is 32 times the spacing of
/// `f64` parameters near 1.
const MAX_HALVINGS: u32 = 48;

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
/// Coefficients of size `noise` or less count as zero: pass the rounding error of the coefficients.
/// Roots without a change of sign (double roots) are left out; a stretch where the polynomial stays
/// within the noise between opposite signs counts as one change, at its middle. Roots are accurate
/// to the rounding of [`value`].
///
/// Cost: `O(n²)` per halving and root, about 3 µs for degree 4.
pub fn sign_changes(coefficients: &[f64], noise: f64) -> Vec<f64> {
    let mut search = Search { noise, last: 0.0, last_at: 0.0, found: Vec::new() };
    if !coefficients.is_empty() {
        search.visit(coefficients.to_vec(), 0.0, 1.0, 0);
    }
    search.found
}

/// A walk over sub-intervals from left to right.
struct Search {
    noise: f64,
    /// Last sign met, 0 before the first.
    last: f64,
    /// Where that sign was last seen.
    last_at: f64,
    found: Vec<f64>,
}

impl Search {
    fn visit(&mut self, c: Vec<f64>, a: f64, b: f64, depth: u32) {
        let signs = || c.iter().filter(|x| x.abs() > self.noise).map(|x| x.signum());
        let (Some(first), Some(end)) = (signs().next(), signs().last()) else {
            return; // all noise
        };
        let variations = signs().zip(signs().skip(1)).filter(|(x, y)| x != y).count();
        if variations > 1 && depth < MAX_HALVINGS {
            let (left, right) = halves(c);
            let middle = 0.5 * (a + b);
            self.visit(left, a, middle, depth + 1);
            self.visit(right, middle, b, depth + 1);
            return;
        }
        self.meet(first, a);
        if first != end {
            let t = bracketed(|t| value(&c, t), 0.0, 1.0, f64::EPSILON * 0.5);
            self.found.push(a + (b - a) * t);
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
