//! Trim curves in space: the surface at the points of a curve in its domain, as one rational curve.
//!
//! ```text
//!   along a trim curve (U, V, W)(t) of degree m, with u = U / W:
//!   W^n B_i(u) = C(n, i) (W - U)^(n-i) U^i                          a polynomial of degree m n, and so is that of v:
//!                                                                   their products make a curve of degree m (n + k)
//! ```
//!
//! Source: T. DeRose, R. Goldman, H. Hagen, S. Mann, *Functional composition algorithms via blossoming*, 1993.

use crate::spline::{Control, Patch};
use glam::{DVec2, DVec3, DVec4};

/// Trim curves whose one parameter changes by no more, of the patch's width, run along the other one.
const STRAIGHT: f64 = 4.0 * f64::EPSILON;

/// The control points of a curve in the domain, in the unit square over `u` and `v`.
pub(super) fn in_unit_square(points: &[DVec3], u: (f64, f64), v: (f64, f64)) -> Vec<DVec3> {
    let local = |p: &DVec3| {
        let q = p.point();
        DVec3::from_point(DVec2::new((q.x - u.0) / (u.1 - u.0), (q.y - v.0) / (v.1 - v.0)), p.z)
    };
    points.iter().map(local).collect()
}

/// The control points of a part of a patch. In contrast to [`Patch::rectangle`] all is done in one place.
pub(super) fn rectangle(patch: &Patch, u: (f64, f64), v: (f64, f64)) -> Vec<DVec4> {
    let mut points = patch.points.clone();
    let (n, k) = (patch.degree_u + 1, patch.degree_v + 1);
    (0..k).for_each(|j| segment(&mut points[j * n..][..n], 1, u));
    (0..n).for_each(|i| segment(&mut points[i..], n, v));
    points
}

/// De Casteljau's algorithm at both ends of a part of `[0, 1]`, on the curve of each `stride`-th point.
fn segment(points: &mut [DVec4], stride: usize, (a, b): (f64, f64)) {
    let last = (points.len() - 1) / stride;
    let mut after = |t: f64| {
        for round in 0..last {
            for i in 0..last - round {
                points[i * stride] = points[i * stride].lerp(points[(i + 1) * stride], t);
            }
        }
    };
    if a > 0.0 {
        after(a);
    }
    let mut before = |t: f64| {
        for round in 1..=last {
            for i in (round..=last).rev() {
                points[i * stride] = points[(i - 1) * stride].lerp(points[i * stride], t);
            }
        }
    };
    if b < 1.0 {
        // what is left of it begins at `a`
        before(if a < 1.0 { (b - a) / (1.0 - a) } else { 1.0 });
    }
}

/// The control points, homogeneous, of a patch along a curve in its unit square, which is homogeneous too.
pub(super) fn compose(patch: &Patch, curve: &[DVec3]) -> Vec<DVec4> {
    let level = |axis: usize| {
        let at = |p: &DVec3| p[axis] / p.z;
        let first = at(&curve[0]);
        curve.iter().all(|p| (at(p) - first).abs() <= STRAIGHT).then_some(first)
    };
    let (n, k) = (patch.degree_u, patch.degree_v);
    if let Some(v) = level(1) {
        let column = |i: usize| (0..=k).map(|j| patch.points[j * (n + 1) + i]).collect();
        let row: Vec<DVec4> = (0..=n).map(|i| de_casteljau(column(i), v)).collect();
        return unscaled(Powers::new(curve, 0, n).scaled_sum(&row));
    }
    let powers_v = Powers::new(curve, 1, k);
    if let Some(u) = level(0) {
        let column: Vec<DVec4> = (0..=k).map(|j| de_casteljau(patch.row(j).to_vec(), u)).collect();
        return unscaled(powers_v.scaled_sum(&column));
    }
    let powers_u = Powers::new(curve, 0, n);
    let mut product = vec![DVec4::ZERO; powers_u.stride + powers_v.stride - 1];
    for (j, power) in powers_v.all.chunks_exact(powers_v.stride).enumerate() {
        add_product(&mut product, &powers_u.scaled_sum(patch.row(j)), power);
    }
    unscaled(product)
}

/// `C(n, i) (W - U)^(n-i) U^i` for each `i`, one behind the other, as coefficients over `C(m n, ·)`.
struct Powers {
    all: Vec<f64>,
    /// Coefficients of one.
    stride: usize,
}

impl Powers {
    fn new(curve: &[DVec3], axis: usize, n: usize) -> Self {
        let m = curve.len() - 1;
        let scales = binomials(m);
        let scaled = |value: fn(f64, f64) -> f64| -> Vec<f64> {
            curve.iter().zip(&scales).map(|(p, scale)| scale * value(p[axis], p.z)).collect()
        };
        let stride = m * n + 1;
        let (below, above) = (powers(&scaled(|x, z| z - x), n, stride), powers(&scaled(|x, _| x), n, stride));
        let mut all = vec![0.0; (n + 1) * stride];
        let choose = binomials(n);
        for (i, (all, choose)) in all.chunks_exact_mut(stride).zip(choose).enumerate() {
            let (below, above) = (&below[(n - i) * stride..], &above[i * stride..]);
            add_product(all, &below[..m * (n - i) + 1], &above[..m * i + 1]);
            all.iter_mut().for_each(|x| *x *= choose);
        }
        Self { all, stride }
    }

    fn scaled_sum(&self, row: &[DVec4]) -> Vec<DVec4> {
        let mut sum = vec![DVec4::ZERO; self.stride];
        for (value, power) in row.iter().zip(self.all.chunks_exact(self.stride)) {
            sum.iter_mut().zip(power).for_each(|(sum, x)| *sum += *value * *x);
        }
        sum
    }
}

/// A polynomial to the powers from 0 to `n`, each at a multiple of `stride`.
fn powers(of: &[f64], n: usize, stride: usize) -> Vec<f64> {
    let mut all = vec![0.0; (n + 1) * stride];
    all[0] = 1.0;
    for i in 0..n {
        let (known, next) = all.split_at_mut((i + 1) * stride);
        let len = (of.len() - 1) * i + 1;
        add_product(next, &known[i * stride..][..len], of);
    }
    all
}

/// Adds `a * b`.
fn add_product<T: Copy + std::ops::AddAssign + std::ops::Mul<f64, Output = T>>(to: &mut [T], a: &[T], b: &[f64]) {
    for (i, x) in a.iter().enumerate() {
        to[i..].iter_mut().zip(b).for_each(|(sum, y)| *sum += *x * *y);
    }
}

/// Bernstein coefficients from coefficients scaled by binomials.
fn unscaled(mut scaled: Vec<DVec4>) -> Vec<DVec4> {
    let scales = binomials(scaled.len() - 1);
    scaled.iter_mut().zip(scales).for_each(|(p, scale)| *p /= scale);
    scaled
}

/// `C(n, k)` for each `k`.
fn binomials(n: usize) -> Vec<f64> {
    let mut all = vec![1.0; n + 1];
    for k in 1..=n {
        all[k] = if k <= n / 2 { all[k - 1] * (n - k + 1) as f64 / k as f64 } else { all[n - k] };
    }
    all
}

fn de_casteljau(mut row: Vec<DVec4>, t: f64) -> DVec4 {
    for last in (0..row.len() - 1).rev() {
        for i in 0..=last {
            row[i] = row[i] * (1.0 - t) + row[i + 1] * t;
        }
    }
    row[0]
}
