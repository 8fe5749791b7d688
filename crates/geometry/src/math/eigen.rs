//! Eigenvectors of symmetric 3 x 3 matrices.
//!
//! ```text
//!   A = R diag(values) Rᵀ        each rotation makes one entry off the diagonal 0, and all of them fade
//! ```
//!
//! Source: C. G. J. Jacobi, *Über ein leichtes Verfahren, die in der Theorie der Säcularstörungen
//! vorkommenden Gleichungen numerisch aufzulösen*, 1846.

/// Sweeps over the three entries; convergence is quadratic, five or six suffice.
const SWEEPS: u32 = 16;

/// Eigenvalues of `a` (only the upper triangle is read) and their eigenvectors, the columns of a rotation or
/// reflection: `vectors[k]` belongs to `values[k]`. Accurate to rounding of the largest entry. Not sorted.
pub fn symmetric(mut a: [[f64; 3]; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let mut vectors = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    for _ in 0..SWEEPS {
        for (p, q, r) in [(0, 1, 2), (0, 2, 1), (1, 2, 0)] {
            let off = a[p.min(q)][p.max(q)];
            if off == 0.0 {
                continue;
            }
            // the smaller of the two angles that make the entry 0
            let theta = (a[q][q] - a[p][p]) / (2.0 * off);
            let t = theta.signum() / (theta.abs() + theta.hypot(1.0));
            let c = 1.0 / t.hypot(1.0);
            let s = t * c;
            let (rp, rq) = (a[p.min(r)][p.max(r)], a[q.min(r)][q.max(r)]);
            a[p][p] -= t * off;
            a[q][q] += t * off;
            a[p][q] = 0.0;
            a[p.min(r)][p.max(r)] = c * rp - s * rq;
            a[q.min(r)][q.max(r)] = s * rp + c * rq;
            let (x, y): ([f64; 3], [f64; 3]) = (vectors[p], vectors[q]);
            vectors[p] = std::array::from_fn(|i| c * x[i] - s * y[i]);
            vectors[q] = std::array::from_fn(|i| s * x[i] + c * y[i]);
        }
    }
    ([a[0][0], a[1][1], a[2][2]], vectors)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `A v = λ v`, and the vectors are orthonormal, over decades of size and for equal values.
    #[test]
    fn vectors_are_kept_in_direction() {
        let mut seed = 7u64;
        let mut number = || {
            seed = seed.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (seed >> 11) as f64 / (1u64 << 52) as f64 - 1.0
        };
        let mut cases = vec![[[2.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 2.0]], [[1.0; 3]; 3], [[0.0; 3]; 3]];
        for k in 0..200 {
            let [a, b, c, d, e, f] = std::array::from_fn(|i| number() * 10f64.powi((k * i as i32) % 7 - 3));
            cases.push([[a, b, c], [b, d, e], [c, e, f]]);
        }
        for a in cases {
            let (values, vectors) = symmetric(a);
            let largest = a.iter().flatten().fold(1e-300, |m: f64, x| m.max(x.abs()));
            for k in 0..3 {
                for i in 0..3 {
                    let image: f64 = (0..3).map(|j| a[i][j] * vectors[k][j]).sum();
                    assert!((image - values[k] * vectors[k][i]).abs() < 2e-15 * 4.0 * largest, "{a:?}");
                    let dot: f64 = (0..3).map(|j| vectors[k][j] * vectors[i][j]).sum();
                    assert!((dot - f64::from(u8::from(i == k))).abs() < 1e-14, "{a:?}");
                }
            }
        }
    }

    #[test]
    fn a_known_matrix() {
        // eigenvalues of [[2, 1], [1, 2]] are 1 and 3
        let (mut values, _) = symmetric([[2.0, 1.0, 0.0], [1.0, 2.0, 0.0], [0.0, 0.0, 5.0]]);
        values.sort_by(f64::total_cmp);
        assert!(values.iter().zip([1.0, 3.0, 5.0]).all(|(v, e)| (v - e).abs() < 1e-15), "{values:?}");
    }
}
