//! Bernstein polynomials: the evaluation that the shaders repeat word for word.

use super::Control;

/// Largest degree of a surface or trim curve, in each direction.
///
/// The evaluation keeps no per-degree table, so the limit is a contract with the file formats
/// (real files reach 14), not a buffer size.
pub const MAX_DEGREE: usize = 15;

/// `n` over `k`, exact for every `n` up to 50.
pub fn binomial(n: usize, k: usize) -> f64 {
    let k = k.min(n - k);
    (0..k).fold(1.0, |b, i| b * (n - i) as f64 / (i + 1) as f64)
}

/// `sum B_i^n(t) p_i` by Horner's scheme in `t / (1 - t)`.
///
/// Exact at both ends: `t = 0` returns `points[0]` and `t = 1` the last point, bit for bit, which
/// is what makes neighbouring patches meet without a crack. Cost: `3 n` multiply-adds a coordinate.
/// Relative error below `2 n` ulp of the largest control value for `t` in `[0, 1]`.
///
/// Source: Farin 2002, section 4.3 (`hornbez`).
pub(super) fn horner<P: Control>(points: &[P], t: f64) -> P {
    let n = points.len() - 1;
    let s = 1.0 - t;
    if n == 0 {
        return points[0];
    }
    let mut factor = 1.0;
    let mut choose = 1.0;
    let mut sum = points[0] * s;
    for (i, &p) in points.iter().enumerate().take(n).skip(1) {
        factor *= t;
        choose *= (n - i + 1) as f64 / i as f64;
        sum = (sum + p * (factor * choose)) * s;
    }
    sum + points[n] * (factor * t)
}

/// Value and first derivative, from the last step of de Casteljau's algorithm:
/// with `a`, `b` the degree `n - 1` values of the first and last `n` points, `p = a + t (b - a)`
/// and `p' = n (b - a)`.
pub(super) fn horner_jet<P: Control>(points: &[P], t: f64) -> (P, P) {
    let n = points.len() - 1;
    if n == 0 {
        return (points[0], P::ZERO);
    }
    let a = horner(&points[..n], t);
    let b = horner(&points[1..], t);
    (a * (1.0 - t) + b * t, (b - a) * n as f64)
}

/// de Casteljau's triangle at `t`: overwrites `points` with the control points of `[0, t]` and
/// returns those of `[t, 1]`. Valid for any real `t` (extrapolation included).
pub(super) fn split<P: Control>(points: &mut [P], t: f64) -> Vec<P> {
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
