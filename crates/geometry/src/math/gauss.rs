//! Integrals of several functions at once: Gauss's rule of 16 points, halved until two answers agree.
//!
//! ```text
//!   rule over [a, b]  ─── agrees with the rules over its halves? ─ yes ──▶ their sum
//!                                        └─ no ──▶ each half in the same way
//! ```

use std::sync::OnceLock;

/// Points of the rule.
const POINTS: usize = 16;
/// [`integrate`] halves a piece at most so often. If the answers still differ, the returned error shows it.
const HALVINGS: u32 = 14;
/// Halvings of all pieces together, at most: where rounding is above the tolerance, each step would double them.
const MOST_HALVED: u32 = 1 << HALVINGS;

/// Abscissae in `[-1, 1]` and weights, roots of the Legendre polynomial by Newton's method.
///
/// Source: M. Abramowitz, I. Stegun, *Handbook of Mathematical Functions*, 1964, 25.4.29.
fn gauss() -> &'static [(f64, f64); POINTS] {
    static RULE: OnceLock<[(f64, f64); POINTS]> = OnceLock::new();
    RULE.get_or_init(|| {
        let n = POINTS as f64;
        std::array::from_fn(|i| {
            let mut x = (std::f64::consts::PI * (i as f64 + 0.75) / (n + 0.5)).cos();
            let mut slope = 1.0;
            for _ in 0..8 {
                let (mut p, mut before) = (1.0, 0.0);
                for k in 0..POINTS {
                    let k = k as f64;
                    (p, before) = (((2.0 * k + 1.0) * x * p - k * before) / (k + 1.0), p);
                }
                slope = n * (x * p - before) / (x * x - 1.0);
                x -= p / slope;
            }
            (x, 2.0 / ((1.0 - x * x) * slope * slope))
        })
    })
}

/// The rule over `[a, b]`.
pub fn rule<const N: usize>(f: &impl Fn(f64) -> [f64; N], a: f64, b: f64) -> [f64; N] {
    let (middle, half) = (0.5 * (a + b), 0.5 * (b - a));
    let mut sum = [0.0; N];
    for (x, weight) in gauss() {
        let value = f(middle + half * x);
        sum.iter_mut().zip(value).for_each(|(s, v)| *s += weight * half * v);
    }
    sum
}

/// The integrals over `[a, b]`, and how far the last two answers were apart, summed over the pieces: an estimate of the
/// error, not a bound. Pieces are halved while that is above `tolerance`, a share of the sum of absolute values.
pub fn integrate<const N: usize>(
    f: &impl Fn(f64) -> [f64; N],
    (a, b): (f64, f64),
    tolerance: f64,
) -> ([f64; N], [f64; N]) {
    let scale = rule(&|t| f(t).map(f64::abs), a, b);
    within(f, (a, b), scale.map(|s| s * tolerance), HALVINGS)
}

/// The same with absolute tolerances. Pieces are halved, at most `halvings` times, while the last two answers differ by
/// more than `allowed`, which each half shares equally. An answer that is not a number ends the halving, and so do 2^14
/// halvings of all pieces together.
pub fn within<const N: usize>(
    f: &impl Fn(f64) -> [f64; N],
    (a, b): (f64, f64),
    allowed: [f64; N],
    halvings: u32,
) -> ([f64; N], [f64; N]) {
    let mut total = ([0.0; N], [0.0; N]);
    let mut remaining = MOST_HALVED;
    halve(f, (a, b), rule(f, a, b), &allowed, (halvings, &mut remaining), &mut total);
    total
}

fn halve<const N: usize>(
    f: &impl Fn(f64) -> [f64; N],
    (a, b): (f64, f64),
    whole: [f64; N],
    allowed: &[f64; N],
    (depth, remaining): (u32, &mut u32),
    total: &mut ([f64; N], [f64; N]),
) {
    let middle = 0.5 * (a + b);
    let (left, right) = (rule(f, a, middle), rule(f, middle, b));
    let apart: [f64; N] = std::array::from_fn(|i| (left[i] + right[i] - whole[i]).abs());
    let is_far = apart.iter().zip(allowed).any(|(d, limit)| d > limit);
    if depth == 0 || *remaining == 0 || !is_far {
        for i in 0..N {
            total.0[i] += left[i] + right[i];
            total.1[i] += apart[i];
        }
        return;
    }
    *remaining -= 1;
    let allowed = allowed.map(|limit| 0.5 * limit);
    halve(f, (a, middle), left, &allowed, (depth - 1, &mut *remaining), total);
    halve(f, (middle, b), right, &allowed, (depth - 1, remaining), total);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_of_degree_31_are_exact() {
        for degree in 0..32 {
            let [sum] = rule(&|x: f64| [x.powi(degree)], 0.0, 1.0);
            assert!((sum * f64::from(degree + 1) - 1.0).abs() < 1e-14, "{degree}: {sum}");
        }
    }

    #[test]
    fn a_corner_is_found_and_the_error_is_reported() {
        let ([sum, smooth], [error, _]) = integrate(&|x: f64| [(x - 0.3).abs(), x.exp()], (0.0, 1.0), 1e-12);
        assert!((sum - 0.29).abs() < 1e-8 && error >= (sum - 0.29).abs() && error < 1e-7, "{sum} {error}");
        assert!((smooth - (1.0_f64.exp() - 1.0)).abs() < 1e-14);
    }

    /// Halving to the end would take two million values.
    #[test]
    fn what_is_no_number_is_not_halved() {
        let values = std::cell::Cell::new(0);
        let f = |_: f64| {
            values.set(values.get() + 1);
            [f64::NAN]
        };
        let ([sum], _) = within(&f, (0.0, 1.0), [1e-12], 16);
        assert!(sum.is_nan() && values.get() == 3 * POINTS, "{}", values.get());
    }

    /// No piece of this is smooth: halving to the end would take sixty million values.
    #[test]
    fn noise_is_not_halved_to_the_end() {
        let values = std::cell::Cell::new(0);
        let f = |t: f64| {
            values.set(values.get() + 1);
            [(1e9 * t).sin()]
        };
        let (_, [error]) = within(&f, (0.0, 1.0), [1e-12], 20);
        // a rule for the whole and two for each piece; each halving makes two pieces of one
        let most = (1 + 2 * (1 + 2 * MOST_HALVED as usize)) * POINTS;
        assert!(error > 1e-12 && values.get() <= most, "{error} {} {most}", values.get());
    }
}
