//! Splines of degree 5 for curves and surfaces that no rational spline reproduces, with a measured error.
//!
//! ```text
//!   f over [a, b]: quintic through six Chebyshev points; error measured at two points between each two
//!   curves     halved where the error is above the target
//!   surfaces   columns and rows of the grid are halved, whichever err
//! ```
//!
//! A surface is interpolated in u, then in v: its error is at most the error in u plus [`LEBESGUE`] times the error in
//! v. The spline keeps the parametrisation: equal parameters are equal points, within the error.

use super::fit::{PEAK, QUINTIC, chebyshev};
use crate::spline::arc::assemble;
use crate::spline::{BSpline, Bezier, Control, Span, Surface};
use glam::{DVec3, DVec4};

const DEGREE: usize = 5;
const NODES: usize = DEGREE + 1;

/// How much interpolation at the six nodes may enlarge an error (its Lebesgue constant is 1.99).
const LEBESGUE: f64 = 2.0;

/// Halvings of a piece of a curve, or of the grid of a surface, before the error stands.
const MAX_DEPTH: u32 = 10;

/// Cells of a surface's grid at most; a quarter of them, and its error stands.
const MAX_CELLS: usize = 1 << 12;

/// A spline along `f`, cut at `breaks` (increasing, both ends among them), and its largest error in mm.
/// `None` when `f` is not finite.
pub(super) fn curve(f: &dyn Fn(f64) -> DVec3, breaks: &[f64], target: f64) -> Option<(BSpline<DVec4>, f64)> {
    let mut spans = Vec::new();
    let mut error: f64 = 0.0;
    for w in breaks.windows(2) {
        piece(f, (w[0], w[1]), target, MAX_DEPTH, &mut spans, &mut error);
    }
    let (degree, knots, points) = if spans.is_empty() { return None } else { assemble(&spans) };
    if !error.is_finite() {
        return None;
    }
    Some((BSpline::new(degree, knots, points).ok()?, error))
}

fn piece(
    f: &dyn Fn(f64) -> DVec3,
    (a, b): (f64, f64),
    target: f64,
    depth: u32,
    spans: &mut Vec<Span<Bezier<DVec4>>>,
    worst: &mut f64,
) {
    let at = |x: f64| f(a + (b - a) * x);
    let points = control(&std::array::from_fn(|i| at(chebyshev(i, DEGREE))));
    let fitted = Bezier { points: points.iter().map(|p| DVec4::from_point(*p, 1.0)).collect() };
    let error = PEAK * between().map(|x| fitted.point(x).distance(at(x))).fold(0.0, f64::max);
    if error > target && depth > 0 {
        let middle = 0.5 * (a + b);
        piece(f, (a, middle), target, depth - 1, spans, worst);
        piece(f, (middle, b), target, depth - 1, spans, worst);
        return;
    }
    // a NaN must not be lost
    *worst = if error >= 0.0 { worst.max(error) } else { f64::NAN };
    spans.push(Span { start: a, end: b, piece: fitted });
}

/// A spline surface along `f` over the grid of `us` and `vs`, and its largest error in mm. `None` when `f`
/// is not finite, or the grid has too many cells to begin with.
pub(super) fn surface(
    f: &dyn Fn(f64, f64) -> DVec3,
    mut us: Vec<f64>,
    mut vs: Vec<f64>,
    target: f64,
) -> Option<(Surface, f64)> {
    let mut passes = 0;
    loop {
        let (nu, nv) = (us.len() - 1, vs.len() - 1);
        if nu * nv > MAX_CELLS {
            return None;
        }
        let (mut err_u, mut err_v) = (vec![0.0f64; nu], vec![0.0f64; nv]);
        let (count_u, count_v) = (DEGREE * nu + 1, DEGREE * nv + 1);
        let mut net = vec![DVec4::ZERO; count_u * count_v];
        for (i, u) in us.windows(2).enumerate() {
            for (j, v) in vs.windows(2).enumerate() {
                let at = |x: f64, y: f64| f(u[0] + (u[1] - u[0]) * x, v[0] + (v[1] - v[0]) * y);
                let node = |k: usize| chebyshev(k, DEGREE);
                let values: [[DVec3; NODES]; NODES] =
                    std::array::from_fn(|l| std::array::from_fn(|k| at(node(k), node(l))));
                let rows: [[DVec3; NODES]; NODES] = std::array::from_fn(|l| control(&values[l]));
                for k in 0..NODES {
                    let column = control(&std::array::from_fn(|l| rows[l][k]));
                    for (l, p) in column.into_iter().enumerate() {
                        net[(j * DEGREE + l) * count_u + i * DEGREE + k] = p.extend(1.0);
                    }
                    let along_v = control(&std::array::from_fn(|l| values[l][k]));
                    for x in between() {
                        err_u[i] = larger(err_u[i], bezier(&rows[k], x).distance(at(x, node(k))));
                        err_v[j] = larger(err_v[j], bezier(&along_v, x).distance(at(node(k), x)));
                    }
                }
            }
        }
        let worst = |errors: &[f64]| errors.iter().copied().fold(0.0, larger);
        let error = PEAK * (worst(&err_u) + LEBESGUE * worst(&err_v));
        if !error.is_finite() {
            return None;
        }
        if error <= target || nu * nv > MAX_CELLS / 4 || passes == MAX_DEPTH {
            let knots = |ends: &[f64]| {
                let inner = ends.iter().flat_map(|k| [*k; DEGREE]);
                std::iter::once(ends[0]).chain(inner).chain([ends[ends.len() - 1]]).collect::<Vec<f64>>()
            };
            return Some((Surface::new((DEGREE, DEGREE), knots(&us), knots(&vs), net).ok()?, error));
        }
        passes += 1;
        us = halved(&us, &err_u, target / (2.0 * PEAK));
        vs = halved(&vs, &err_v, target / (2.0 * PEAK * LEBESGUE));
    }
}

/// Cuts the intervals whose error is above `target`.
fn halved(ends: &[f64], errors: &[f64], target: f64) -> Vec<f64> {
    let mut out = vec![ends[0]];
    for (w, error) in ends.windows(2).zip(errors) {
        if *error > target {
            out.push(0.5 * (w[0] + w[1]));
        }
        out.push(w[1]);
    }
    out
}

/// The larger one; a NaN stays.
fn larger(a: f64, b: f64) -> f64 {
    if b > a || b.is_nan() { b } else { a }
}

/// Two points between each two nodes.
fn between() -> impl Iterator<Item = f64> {
    (0..2 * DEGREE).map(|i| {
        let (x0, x1) = (chebyshev(i / 2, DEGREE), chebyshev(i / 2 + 1, DEGREE));
        x0 + (x1 - x0) * if i % 2 == 0 { 0.3 } else { 0.7 }
    })
}

/// Bézier points of the quintic through the values at the nodes; ends bit for bit.
fn control(values: &[DVec3; NODES]) -> [DVec3; NODES] {
    std::array::from_fn(|i| match i {
        0 | DEGREE => values[i],
        _ => (0..NODES).map(|j| values[j] * QUINTIC[i * NODES + j]).sum(),
    })
}

/// De Casteljau.
fn bezier(points: &[DVec3; NODES], x: f64) -> DVec3 {
    let mut p = *points;
    for n in (1..NODES).rev() {
        (0..n).for_each(|i| p[i] = p[i].lerp(p[i + 1], x));
    }
    p[0]
}
