//! The nearest points of two pieces, by Newton's method in the box of their parameters.
//!
//! `f(x, y) = |A(x) - B(y)|² / 2` with its exact second derivatives; a matrix that is not positive definite, and a step
//! that does not lower `f`, are damped (D. Marquardt, *An algorithm for least-squares estimation of nonlinear
//! parameters*, 1963). A parameter at the border of the box is held there while `f` falls towards the outside.

use super::Source;
use glam::{DVec2, DVec3};

/// Steps, most.
const STEPS: usize = 80;
/// The largest damping; beyond it steps are rounding.
const MOST_DAMPING: f64 = 1e12;
/// Of steps that change the distance by less than this share of it, one more is made.
const STILL: f64 = 1e-15;

/// A box of parameters of a source.
pub(super) struct Place<'a, 'b> {
    pub source: &'a Source<'b>,
    pub low: DVec2,
    pub high: DVec2,
}

/// A pair of points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    pub at: [DVec2; 2],
    pub points: [DVec3; 2],
    pub distance: f64,
}

/// `f` and its derivatives; unused parameters have none.
struct Value {
    points: [DVec3; 2],
    f: f64,
    gradient: [f64; 4],
    hessian: [[f64; 4]; 4],
}

/// From the middles of two boxes.
pub(super) fn nearest(a: &Place<'_, '_>, b: &Place<'_, '_>) -> Found {
    let places = [a, b];
    // parameters in use: those of a curve are its first
    let used: [bool; 4] = std::array::from_fn(|i| i % 2 < places[i / 2].source.dimension());
    let low: [f64; 4] = std::array::from_fn(|i| places[i / 2].low[i % 2]);
    let high: [f64; 4] = std::array::from_fn(|i| places[i / 2].high[i % 2]);
    let value = |x: &[f64; 4]| value([a.source, b.source], x);
    let mut x: [f64; 4] = std::array::from_fn(|i| 0.5 * (low[i] + high[i]));
    let mut now = value(&x);
    let (mut damping, mut is_still) = (0.0_f64, false);
    for _ in 0..STEPS {
        let free: Vec<usize> = (0..4)
            .filter(|&i| {
                let held = x[i] <= low[i] && now.gradient[i] >= 0.0 || x[i] >= high[i] && now.gradient[i] <= 0.0;
                used[i] && !held
            })
            .collect();
        if free.is_empty() || now.f == 0.0 {
            break;
        }
        let next = solve(&now, &free, damping).map(|step| {
            let next: [f64; 4] = std::array::from_fn(|i| (x[i] - step[i]).clamp(low[i], high[i]));
            (next, value(&next))
        });
        match next {
            Some((place, there)) if there.f <= now.f => {
                let change = now.f.sqrt() - there.f.sqrt();
                let is_done = place == x || is_still && change <= STILL * there.f.sqrt();
                is_still = change <= STILL * there.f.sqrt();
                (x, now) = (place, there);
                damping *= 0.1;
                if is_done {
                    break;
                }
            }
            _ => {
                damping = (damping * 10.0).max(1e-6);
                if damping > MOST_DAMPING {
                    break;
                }
            }
        }
    }
    let at = [DVec2::new(x[0], x[1]), DVec2::new(x[2], x[3])];
    Found { at, points: now.points, distance: now.points[0].distance(now.points[1]) }
}

fn value(sources: [&Source<'_>; 2], x: &[f64; 4]) -> Value {
    let [a, b] = [0, 1].map(|i| sources[i].jet(DVec2::new(x[2 * i], x[2 * i + 1])));
    let apart = a.point - b.point;
    // derivatives of A - B
    let first = [a.d[0], a.d[1], -b.d[0], -b.d[1]];
    let mut hessian = [[0.0; 4]; 4];
    for (i, row) in hessian.iter_mut().enumerate() {
        for (j, entry) in row.iter_mut().enumerate() {
            let second = match (i / 2, j / 2) {
                (0, 0) => a.dd[i + j],
                (1, 1) => -b.dd[i + j - 4],
                _ => DVec3::ZERO,
            };
            *entry = first[i].dot(first[j]) + apart.dot(second);
        }
    }
    Value {
        points: [a.point, b.point],
        f: 0.5 * apart.length_squared(),
        gradient: first.map(|d| apart.dot(d)),
        hessian,
    }
}

/// `(H + damping diag |H|) s = g` over the free parameters, by Cholesky's method; `None` where the matrix is not
/// positive definite.
fn solve(at: &Value, free: &[usize], damping: f64) -> Option<[f64; 4]> {
    let n = free.len();
    let largest = free.iter().map(|i| at.hessian[*i][*i].abs()).fold(f64::MIN_POSITIVE, f64::max);
    let mut lower = [[0.0_f64; 4]; 4];
    for r in 0..n {
        for c in 0..=r {
            let mut sum = at.hessian[free[r]][free[c]];
            if r == c {
                sum += damping * sum.abs().max(1e-12 * largest);
            }
            sum -= (0..c).map(|k| lower[r][k] * lower[c][k]).sum::<f64>();
            if r == c {
                if sum <= 1e-14 * at.hessian[free[r]][free[r]].abs().max(1e-12 * largest) {
                    return None;
                }
                lower[r][r] = sum.sqrt();
            } else {
                lower[r][c] = sum / lower[c][c];
            }
        }
    }
    let mut y = [0.0; 4];
    for r in 0..n {
        let sum: f64 = (0..r).map(|k| lower[r][k] * y[k]).sum();
        y[r] = (at.gradient[free[r]] - sum) / lower[r][r];
    }
    let mut step = [0.0; 4];
    for r in (0..n).rev() {
        let sum: f64 = (r + 1..n).map(|k| lower[k][r] * step[free[k]]).sum();
        step[free[r]] = (y[r] - sum) / lower[r][r];
    }
    Some(step)
}
