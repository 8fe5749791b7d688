//! A function of one parameter as a B-spline of degree 5, as close as `f64` reasonably can be.
//!
//! ```text
//!   a ●──────●───────●───────●──────● b      interpolated at Chebyshev points; halved until the
//!      ✕    ✕    ✕       ✕    ✕    ✕         spline is right in between, too
//! ```

use crate::spline::{BSpline, binomial};
use glam::{DVec3, DVec4};
use std::sync::LazyLock;

const DEGREE: usize = 5;

/// Error that is good enough, of the diagonal of the curve's box: a tenth of what trims aim at.
const ENOUGH: f64 = 1e-10;

/// Halvings of one piece at most; each divides the error of a smooth function by 64.
const HALVINGS: u32 = 8;

/// The spline over `breaks`, increasing, between which `at` is smooth; `None` where a value is not
/// finite.
///
/// Accuracy: [`ENOUGH`], where [`HALVINGS`] suffice.
pub(super) fn fit(at: impl Fn(f64) -> DVec3, breaks: &[f64]) -> Option<BSpline<DVec4>> {
    let (mut lo, mut hi) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for w in breaks.windows(2) {
        for i in 0..4 {
            let p = at(w[0] + (w[1] - w[0]) * f64::from(i) / 4.0);
            (lo, hi) = (lo.min(p), hi.max(p));
        }
    }
    let enough = ENOUGH * (hi - lo).length() + f64::EPSILON * lo.abs().max(hi.abs()).length();
    let mut knots = vec![breaks[0]; DEGREE + 1];
    let mut points = vec![at(breaks[0])];
    for w in breaks.windows(2) {
        piece(&at, (w[0], w[1]), enough, HALVINGS, (&mut knots, &mut points));
    }
    knots.push(*breaks.last()?);
    let points = points.into_iter().map(|p| p.extend(1.0)).collect();
    BSpline::new(DEGREE, knots, points).ok()
}

fn piece(
    at: &impl Fn(f64) -> DVec3,
    (a, b): (f64, f64),
    enough: f64,
    halvings: u32,
    out: (&mut Vec<f64>, &mut Vec<DVec3>),
) {
    let node = |i: usize| 0.5 - 0.5 * (std::f64::consts::PI * i as f64 / DEGREE as f64).cos();
    let local = |x: f64| a + (b - a) * x;
    let mut values: Vec<DVec3> = (0..=DEGREE).map(|i| at(local(node(i)))).collect();
    values[0] = out.1[out.1.len() - 1];
    values[DEGREE] = at(b);
    let row = |i: usize| (0..=DEGREE).map(|j| values[j] * INVERSE[i * (DEGREE + 1) + j]).sum::<DVec3>();
    let mut control: Vec<DVec3> = (0..=DEGREE).map(row).collect();
    (control[0], control[DEGREE]) = (values[0], values[DEGREE]);
    let curve = |x: f64| (0..=DEGREE).map(|i| control[i] * bernstein(i, x)).sum::<DVec3>();
    let wrong = (0..DEGREE).any(|i| {
        let x = 0.5 * (node(i) + node(i + 1));
        curve(x).distance(at(local(x))) > enough
    });
    let middle = 0.5 * (a + b);
    if wrong && halvings > 0 && a < middle && middle < b {
        piece(at, (a, middle), enough, halvings - 1, (&mut *out.0, &mut *out.1));
        piece(at, (middle, b), enough, halvings - 1, out);
        return;
    }
    out.1.extend_from_slice(&control[1..]);
    out.0.extend([b; DEGREE]);
}

fn bernstein(i: usize, t: f64) -> f64 {
    binomial(DEGREE, i) * t.powi(i as i32) * (1.0 - t).powi((DEGREE - i) as i32)
}

/// From values at the Chebyshev points to control points.
static INVERSE: LazyLock<Vec<f64>> = LazyLock::new(|| {
    let n = DEGREE + 1;
    let node = |i: usize| 0.5 - 0.5 * (std::f64::consts::PI * i as f64 / DEGREE as f64).cos();
    let mut m = vec![0.0; 2 * n * n];
    for r in 0..n {
        (0..n).for_each(|c| m[r * 2 * n + c] = bernstein(c, node(r)));
        m[r * 2 * n + n + r] = 1.0;
    }
    // Gauss-Jordan; the matrix is diagonally heavy enough to need no pivots
    for p in 0..n {
        let pivot = m[p * 2 * n + p];
        (0..2 * n).for_each(|c| m[p * 2 * n + c] /= pivot);
        for r in (0..n).filter(|r| *r != p) {
            let factor = m[r * 2 * n + p];
            (0..2 * n).for_each(|c| m[r * 2 * n + c] -= factor * m[p * 2 * n + c]);
        }
    }
    (0..n).flat_map(|r| m[r * 2 * n + n..(r + 1) * 2 * n].to_vec()).collect()
});

#[cfg(test)]
mod tests {
    use super::*;

    /// A helix of radius 2: the distance of a point from it has a closed form.
    #[test]
    fn a_helix() {
        let helix = |t: f64| DVec3::new(2.0 * t.cos(), 2.0 * t.sin(), 0.3 * t);
        let spline = fit(helix, &[0.0, 1.0, 7.0]).unwrap();
        let worst = (0..=1000).map(|i| 7e-3 * f64::from(i)).map(|t| spline.point(t).distance(helix(t)));
        let worst = worst.fold(0.0, f64::max);
        // 1e-10 of a box with a diagonal of about 6 mm, and twice that between the points looked at
        assert!(worst < 1.2e-9, "{worst:e}");
        assert_eq!(spline.point(0.0), helix(0.0));
        assert_eq!(spline.point(7.0), helix(7.0));
    }

    #[test]
    fn values_that_are_not_finite() {
        assert!(fit(|t| DVec3::splat(1.0 / (t - 0.5)), &[0.0, 1.0]).is_some_and(|s| s.points().len() < 5000));
        assert!(fit(|_| DVec3::NAN, &[0.0, 1.0]).is_none());
    }
}
