//! The error of a fit in each cell, with its bound and its share in `u` and `v`.

use super::sides::Sampler;
use crate::construct::ConstructError;
use crate::spline::{Basis, Surface};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;
use std::sync::LazyLock;

/// Chebyshev points of a cell along each parameter.
const POINTS: usize = 8;
/// Degree up to which the error is a polynomial, for the factor.
const SMOOTH: usize = 4;
/// `1 / cos²(SMOOTH π / (2 POINTS))`: both directions together.
const FACTOR: f64 = 2.0;

/// `COSINES[k][i] = T_k(x_i)` at the points `x_i = cos(π (2 i + 1) / 16)`.
static COSINES: LazyLock<[[f64; POINTS]; POINTS]> = LazyLock::new(|| {
    std::array::from_fn(|k| std::array::from_fn(|i| (PI * (k * (2 * i + 1)) as f64 / (2 * POINTS) as f64).cos()))
});

/// The error of one cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cell {
    /// Upper bound of the error.
    pub bound: f64,
    /// Largest error at a point.
    pub measured: f64,
    /// Share of the error that changes along `u`; the rest changes along `v`.
    pub along_u: f64,
}

/// All cells of a fit.
pub(super) struct Report {
    /// `cells[j * spans_u + i]`.
    pub cells: Vec<Cell>,
    /// The largest bound.
    pub bound: f64,
    /// The largest measured error.
    pub measured: f64,
}

/// Chebyshev points of each span, with the B-splines there.
fn stations(lines: &[f64], degree: usize, knots: &[f64], count: usize) -> Vec<[(f64, Basis); POINTS]> {
    let station = |a: f64, b: f64, i: usize| {
        let t = 0.5 * (a + b) + 0.5 * (b - a) * COSINES[1][i];
        (t, Basis::new(degree, knots, count, t))
    };
    lines.windows(2).map(|w| std::array::from_fn(|i| station(w[0], w[1], i))).collect()
}

/// Compares the surface with its definition. `rounding` is added to every bound.
///
/// # Errors
/// [`ConstructError::NotFiniteAt`].
pub(super) fn check(
    sampler: &Sampler<'_>,
    surface: &Surface,
    lu: &[f64],
    lv: &[f64],
    rounding: f64,
) -> Result<Report, ConstructError> {
    let ((pu, pv), (ku, kv), (nu, nv)) = (surface.degrees(), surface.knots(), surface.counts());
    let (us, vs) = (stations(lu, pu, ku, nu), stations(lv, pv, kv, nv));
    let row = |v: &[(f64, Basis); POINTS]| {
        us.iter().map(|u| cell(sampler, surface, u, v, rounding)).collect::<Result<Vec<Cell>, _>>()
    };
    let rows: Result<Vec<Vec<Cell>>, _> = vs.par_iter().map(row).collect();
    let cells = rows?.concat();
    let largest = |of: fn(&Cell) -> f64| cells.iter().map(of).fold(0.0, f64::max);
    Ok(Report { bound: largest(|c| c.bound), measured: largest(|c| c.measured), cells })
}

fn cell(
    sampler: &Sampler<'_>,
    surface: &Surface,
    us: &[(f64, Basis); POINTS],
    vs: &[(f64, Basis); POINTS],
    rounding: f64,
) -> Result<Cell, ConstructError> {
    let count_u = surface.counts().0;
    let mut errors = [[DVec3::ZERO; POINTS]; POINTS];
    let mut measured: f64 = 0.0;
    for (row, (v, bv)) in errors.iter_mut().zip(vs) {
        for (error, (u, bu)) in row.iter_mut().zip(us) {
            let mut point = DVec3::ZERO;
            for (j, y) in bv.values().iter().enumerate() {
                let points = &surface.points()[(bv.first + j) * count_u + bu.first..];
                let inner = bu.values().iter().zip(points).fold(DVec3::ZERO, |s, (x, p)| s + p.truncate() * *x);
                point += inner * *y;
            }
            *error = point - sampler.at(*u, *v)?;
            measured = measured.max(error.length());
        }
    }
    let series = chebyshev(&errors);
    let (mut rest, mut in_u, mut in_v) = (0.0, 0.0, 0.0);
    for (l, row) in series.iter().enumerate() {
        for (k, c) in row.iter().enumerate() {
            let size = c.length();
            if k > SMOOTH || l > SMOOTH {
                rest += size;
            }
            if k > 0 && l == 0 {
                in_u += size;
            }
            if l > 0 && k == 0 {
                in_v += size;
            }
        }
    }
    let along_u = if in_u + in_v > 0.0 { in_u / (in_u + in_v) } else { 0.5 };
    Ok(Cell { bound: FACTOR * (measured + rest) + 2.0 * rest + rounding, measured, along_u })
}

/// Coefficients of the Chebyshev series through the values: a discrete cosine transform in each direction.
fn chebyshev(values: &[[DVec3; POINTS]; POINTS]) -> [[DVec3; POINTS]; POINTS] {
    let share = |k: usize| if k == 0 { 1.0 / POINTS as f64 } else { 2.0 / POINTS as f64 };
    let along = |row: &[DVec3; POINTS]| -> [DVec3; POINTS] {
        std::array::from_fn(|k| row.iter().zip(&COSINES[k]).fold(DVec3::ZERO, |s, (x, c)| s + *x * *c) * share(k))
    };
    let half: [[DVec3; POINTS]; POINTS] = std::array::from_fn(|j| along(&values[j]));
    let turned: [[DVec3; POINTS]; POINTS] = std::array::from_fn(|k| along(&std::array::from_fn(|j| half[j][k])));
    std::array::from_fn(|l| std::array::from_fn(|k| turned[k][l]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_series_comes_back() {
        // 3 T_2(u) T_5(v) - T_0 T_1
        let values = std::array::from_fn(|j| {
            std::array::from_fn(|i| DVec3::X * (3.0 * COSINES[2][i] * COSINES[5][j] - COSINES[1][j]))
        });
        let series = chebyshev(&values);
        for (l, row) in series.iter().enumerate() {
            for (k, c) in row.iter().enumerate() {
                let expected = if (k, l) == (2, 5) {
                    3.0
                } else if (k, l) == (0, 1) {
                    -1.0
                } else {
                    0.0
                };
                assert!((c.x - expected).abs() < 1e-14, "c[{k}][{l}] = {}", c.x);
            }
        }
    }

    /// The factor is Ehlich and Zeller's: `T_4` between its values at 8 points reaches `1 / cos(π / 4)` times the
    /// largest of them at most.
    #[test]
    fn the_factor_holds() {
        let single = 1.0 / (PI * SMOOTH as f64 / (2 * POINTS) as f64).cos();
        assert!((single * single - FACTOR).abs() < 1e-12);
        let seen = COSINES[4].iter().fold(0.0f64, |m, x| m.max(x.abs()));
        assert!(1.0 <= single * seen * (1.0 + 1e-12) && seen < 0.8);
    }
}
