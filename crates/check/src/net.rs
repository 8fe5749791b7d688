//! Bernstein nets of any vector type: values, slopes, bounds and halves, without allocation.
//!
//! `net[j * (n + 1) + i]` is the control value `P_ij`, `i` along `u`, degrees `n` along `u` and `m`
//! along `v`, over the unit square. Sources: Farin 2002, chapters 4 and 5.

use crate::spline::MAX_DEGREE;
use glam::DVec2;
use std::ops::{Add, Mul, Sub};

/// The element of a net.
pub(super) trait Value:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> + Default
{
}
impl<T: Copy + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T> + Default> Value for T {}

/// Degrees along `u` and `v`.
pub(super) type Degrees = (usize, usize);

/// Control values in a net.
pub(super) fn count((n, m): Degrees) -> usize {
    (n + 1) * (m + 1)
}

/// The Bernstein polynomials `B_i^n` and their derivatives at one parameter.
struct Basis {
    value: [f64; MAX_DEGREE + 1],
    slope: [f64; MAX_DEGREE + 1],
}

impl Basis {
    /// `B_i^n = (1 - t) B_i^(n-1) + t B_(i-1)^(n-1)` up from degree 0, and
    /// `(B_i^n)' = n (B_(i-1)^(n-1) - B_i^(n-1))` at the last step.
    fn new(n: usize, t: f64) -> Self {
        let s = 1.0 - t;
        let mut value = [0.0; MAX_DEGREE + 1];
        let mut slope = [0.0; MAX_DEGREE + 1];
        value[0] = 1.0;
        for k in 1..=n {
            let mut before = 0.0;
            for i in 0..=k {
                let here = if i < k { value[i] } else { 0.0 };
                if k == n {
                    slope[i] = n as f64 * (before - here);
                }
                value[i] = s * here + t * before;
                before = here;
            }
        }
        Self { value, slope }
    }
}

/// Value and both first derivatives at `(u, v)`.
pub(super) fn jet<T: Value>(net: &[T], (n, m): Degrees, u: f64, v: f64) -> (T, T, T) {
    let (bu, bv) = (Basis::new(n, u), Basis::new(m, v));
    let (mut p, mut pu, mut pv) = (T::default(), T::default(), T::default());
    for (j, row) in net.chunks_exact(n + 1).enumerate() {
        let (mut r, mut ru) = (T::default(), T::default());
        for (i, &c) in row.iter().enumerate() {
            r = r + c * bu.value[i];
            ru = ru + c * bu.slope[i];
        }
        p = p + r * bv.value[j];
        pu = pu + ru * bv.value[j];
        pv = pv + r * bv.slope[j];
    }
    (p, pu, pv)
}

/// Control values of the derivative along `u`: `n (P_(i+1)j - P_ij)`.
pub(super) fn slopes_u<T: Value>(net: &[T], (n, _): Degrees) -> impl Iterator<Item = T> + '_ {
    net.chunks_exact(n + 1).flat_map(move |row| row.windows(2).map(move |w| (w[1] - w[0]) * n as f64))
}

/// Control values of the derivative along `v`: `m (P_i(j+1) - P_ij)`.
pub(super) fn slopes_v<T: Value>(net: &[T], (n, m): Degrees) -> impl Iterator<Item = T> + '_ {
    net.iter().zip(&net[n + 1..]).map(move |(&a, &b)| (b - a) * m as f64)
}

/// Means of the derivative control values: the linear map nearest to the net.
pub(super) fn mean_slopes<T: Value>(net: &[T], (n, m): Degrees) -> (T, T) {
    let (mut u, mut v) = (T::default(), T::default());
    for row in net.chunks_exact(n + 1) {
        u = u + (row[n] - row[0]);
    }
    let (first, last) = (&net[..=n], &net[m * (n + 1)..]);
    for (&a, &b) in first.iter().zip(last) {
        v = v + (b - a);
    }
    (u * (1.0 / (m + 1) as f64), v * (1.0 / (n + 1) as f64))
}

/// Smallest box of the control values; the whole net lies inside.
pub(super) fn bounds(net: &[DVec2]) -> (DVec2, DVec2) {
    net.iter().fold((net[0], net[0]), |(lo, hi), &p| (lo.min(p), hi.max(p)))
}

/// Halves the net along `u`: `low` becomes the half over `[0, 1/2]`, `high` receives the other.
pub(super) fn halve_u<T: Value>(low: &mut [T], high: &mut [T], (n, m): Degrees) {
    for j in 0..=m {
        halve(low, high, j * (n + 1), 1, n);
    }
}

/// Halves the net along `v`.
pub(super) fn halve_v<T: Value>(low: &mut [T], high: &mut [T], (n, m): Degrees) {
    for i in 0..=n {
        halve(low, high, i, n + 1, m);
    }
}

/// de Casteljau at 1/2 on the `n + 1` values at `first, first + step, ...`: after pass `k` the value
/// at place `k` is the left half's, and the one at the end is the right half's at place `n - k`.
fn halve<T: Value>(low: &mut [T], high: &mut [T], first: usize, step: usize, n: usize) {
    let at = |i: usize| first + i * step;
    high[at(n)] = low[at(n)];
    for k in 1..=n {
        for i in (k..=n).rev() {
            low[at(i)] = (low[at(i - 1)] + low[at(i)]) * 0.5;
        }
        high[at(n - k)] = low[at(n)];
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::spline::Patch;
    use glam::DVec4;

    /// A net with no symmetry, degrees 4 and 3.
    fn sample() -> Patch {
        let points = (0..20)
            .map(|k| {
                let a = f64::from(k);
                DVec4::new((a * 1.7).sin(), (a * 2.3).cos(), (a * 0.9).sin(), 1.0 + 0.3 * (a * 1.1).cos())
            })
            .collect();
        Patch { degree_u: 4, degree_v: 3, points }
    }

    #[test]
    fn jets_are_those_of_horner() {
        let patch = sample();
        for (u, v) in [(0.0, 0.0), (1.0, 0.25), (0.3, 0.8), (0.5, 1.0), (1.02, -0.03)] {
            let (p, pu, pv) = jet(&patch.points, (4, 3), u, v);
            let (q, qu, qv) = patch.homogeneous_jet(u, v);
            assert!((p - q).length() + (pu - qu).length() + (pv - qv).length() < 1e-13, "at {u}, {v}");
        }
    }

    #[test]
    fn halves_are_those_of_split() {
        let patch = sample();
        let (mut low, mut high) = (patch.points.clone(), patch.points.clone());
        halve_u(&mut low, &mut high, (4, 3));
        let (a, b) = patch.split_u(0.5);
        assert!(low.iter().chain(&high).zip(a.points.iter().chain(&b.points)).all(|(p, q)| (*p - *q).length() < 1e-15));
        let (mut low, mut high) = (patch.points.clone(), patch.points.clone());
        halve_v(&mut low, &mut high, (4, 3));
        let (a, b) = patch.split_v(0.5);
        assert!(low.iter().chain(&high).zip(a.points.iter().chain(&b.points)).all(|(p, q)| (*p - *q).length() < 1e-15));
    }

    #[test]
    fn slopes_enclose_and_average() {
        let net: Vec<DVec2> = sample().points.iter().map(|p| DVec2::new(p.x, p.y)).collect();
        let (_, du, dv) = jet(&net, (4, 3), 0.37, 0.61);
        let (lo, hi) = bounds(&slopes_u(&net, (4, 3)).collect::<Vec<_>>());
        assert!(du.cmpge(lo).all() && du.cmple(hi).all());
        let (lo, hi) = bounds(&slopes_v(&net, (4, 3)).collect::<Vec<_>>());
        assert!(dv.cmpge(lo).all() && dv.cmple(hi).all());
        let (mu, mv) = mean_slopes(&net, (4, 3));
        let mean = |s: Vec<DVec2>| s.iter().copied().sum::<DVec2>() / s.len() as f64;
        assert!((mu - mean(slopes_u(&net, (4, 3)).collect())).length() < 1e-14);
        assert!((mv - mean(slopes_v(&net, (4, 3)).collect())).length() < 1e-14);
    }
}
