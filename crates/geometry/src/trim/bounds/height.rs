//! Heights over a plane, of patches and of curves on them, as quotients of Bernstein polynomials.
//!
//! ```text
//!   height · weight = Σ B_i B_j (along · P_ij + offset w_ij)        a patch: one net of pairs (height · weight, weight)
//!
//!   along a trim curve (U, V, W)(t) of degree m, with u = U / W:
//!   W^n B_i(u) = C(n, i) (W - U)^(n-i) U^i                          a polynomial of degree m n, and so is that of v:
//!                                                                   their products make a curve of degree m (n + k)
//! ```
//!
//! *A quotient whose weights are positive is nowhere above the largest quotient of its coefficients.* The differences
//! of `height · weight - h weight` along one parameter say whether there is a critical point of height `h`: where all
//! have one sign, there is none. The quotient's derivative, times the weight, is a mean of them there.
//!
//! Source: T. DeRose, R. Goldman, H. Hagen, S. Mann, *Functional composition algorithms via blossoming*, 1993.

use crate::spline::{Control, Net, Patch, binomial};
use glam::{DVec2, DVec3, DVec4};

/// Pairs of height times weight, and weight.
pub(super) type Height = Net<DVec2>;

/// Trim curves whose one parameter changes by no more, of the patch's width, run along the other one.
const STRAIGHT: f64 = 4.0 * f64::EPSILON;
/// Rounding of heights: each is a sum of a few rounded products.
pub(super) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The upward direction, and the height of the origin.
#[derive(Clone, Copy, Debug)]
pub(super) struct Up {
    pub along: DVec3,
    pub offset: f64,
}

impl Up {
    pub fn of_point(&self, p: DVec3) -> f64 {
        self.along.dot(p) + self.offset
    }

    fn of_control(&self, p: DVec4) -> DVec2 {
        DVec2::new(self.along.dot(p.truncate()) + self.offset * p.w, p.w)
    }

    pub fn of_patch(&self, patch: &Patch) -> Height {
        let n = patch.degree_u + 1;
        Net::build(patch.degree_u, patch.degree_v, |i, j| self.of_control(patch.points[j * n + i]))
    }
}

/// Height of a pair.
pub(super) fn quotient(pair: DVec2) -> f64 {
    pair.x / pair.y
}

impl Height {
    /// An upper bound of the height; infinite where a weight is not positive.
    pub(super) fn upper(&self) -> f64 {
        let bound = |pair: &DVec2| if pair.y > 0.0 { quotient(*pair) } else { f64::INFINITY };
        self.all().iter().map(bound).fold(f64::NEG_INFINITY, f64::max)
    }

    /// A lower bound of the height; infinite where a weight is not positive.
    pub(super) fn lower(&self) -> f64 {
        let bound = |pair: &DVec2| if pair.y > 0.0 { quotient(*pair) } else { f64::NEG_INFINITY };
        self.all().iter().map(bound).fold(f64::INFINITY, f64::min)
    }

    /// Whether it may have a critical point whose height is between two that are finite.
    pub(super) fn may_turn(&self, low: f64, high: f64) -> bool {
        let largest = self.all().iter().fold(DVec2::ZERO, |all, pair| all.max(pair.abs()));
        let noise = ROUNDING * (largest.x + low.abs().max(high.abs()) * largest.y);
        let signs = |a: DVec2, b: DVec2| {
            let step = b - a;
            let (at_low, at_high) = (step.x - low * step.y, step.x - high * step.y);
            (at_low.min(at_high) > noise, at_low.max(at_high) < -noise)
        };
        let one_sign = |pairs: &mut dyn Iterator<Item = (DVec2, DVec2)>| {
            let (mut any, mut rises, mut falls) = (false, true, true);
            for (a, b) in pairs {
                let (up, down) = signs(a, b);
                (any, rises, falls) = (true, rises && up, falls && down);
                if !rises && !falls {
                    return false;
                }
            }
            any
        };
        let (n, k) = (self.n, self.k);
        let mut along_u = (0..=k).flat_map(|j| (0..n).map(move |i| (self.at(i, j), self.at(i + 1, j))));
        let mut along_v = (0..=n).flat_map(|i| (0..k).map(move |j| (self.at(i, j), self.at(i, j + 1))));
        !one_sign(&mut along_u) && !one_sign(&mut along_v)
    }

    /// Whether its second derivatives, or else its first, are larger along `v` than along `u` about a height.
    pub(super) fn is_steeper_in_v(&self, height: f64) -> bool {
        let at = |i: usize, j: usize| self.at(i, j).x - height * self.at(i, j).y;
        let (n, k) = (self.n, self.k);
        let largest = |all: &mut dyn Iterator<Item = f64>| all.map(f64::abs).fold(0.0, f64::max);
        let bend_u = largest(
            &mut (0..=k).flat_map(|j| (1..n.max(1)).map(move |i| at(i - 1, j) - 2.0 * at(i, j) + at(i + 1, j))),
        );
        let bend_v = largest(
            &mut (0..=n).flat_map(|i| (1..k.max(1)).map(move |j| at(i, j - 1) - 2.0 * at(i, j) + at(i, j + 1))),
        );
        if bend_u > 0.0 || bend_v > 0.0 {
            return bend_v > bend_u;
        }
        let step_u = largest(&mut (0..=k).flat_map(|j| (0..n).map(move |i| at(i + 1, j) - at(i, j))));
        let step_v = largest(&mut (0..=n).flat_map(|i| (0..k).map(move |j| at(i, j + 1) - at(i, j))));
        step_v > step_u
    }

    /// The line of the net at one end of `u`, as a net of degree 0 along `u`.
    pub(super) fn side_u(&self, last: bool) -> Self {
        Self::build(0, self.k, |_, j| self.at(if last { self.n } else { 0 }, j))
    }

    /// The same at one end of `v`.
    pub(super) fn side_v(&self, last: bool) -> Self {
        Self::build(self.n, 0, |i, _| self.at(i, if last { self.k } else { 0 }))
    }

    /// Along a curve in the patch's unit square, homogeneous: a net of degree 0 along `v`.
    pub(super) fn along(&self, curve: &[DVec3]) -> Self {
        let level = |axis: usize| {
            let at = |p: &DVec3| p[axis] / p.z;
            let first = at(&curve[0]);
            curve.iter().all(|p| (at(p) - first).abs() <= STRAIGHT).then_some(first)
        };
        let (powers_u, n) = (|| Powers::new(curve, 0, self.n), self.n);
        if let Some(v) = level(1) {
            let row: Vec<DVec2> =
                (0..=n).map(|i| de_casteljau((0..=self.k).map(|j| self.at(i, j)).collect(), v)).collect();
            return powers_u().sum(&row);
        }
        let columns: Vec<Vec<DVec2>> = (0..=self.k).map(|j| (0..=n).map(|i| self.at(i, j)).collect()).collect();
        let powers_v = Powers::new(curve, 1, self.k);
        if let Some(u) = level(0) {
            let column: Vec<DVec2> = columns.into_iter().map(|row| de_casteljau(row, u)).collect();
            return powers_v.sum(&column);
        }
        let powers_u = powers_u();
        let degree = powers_u.degree() + powers_v.degree();
        let mut product = vec![DVec2::ZERO; degree + 1];
        for (row, power) in columns.iter().zip(&powers_v.all) {
            add_product(&mut product, &powers_u.scaled_sum(row), power);
        }
        unscaled(product)
    }
}

/// `C(n, i) (W - U)^(n-i) U^i` for each `i`, as coefficients over `C(degree, ·)`.
struct Powers {
    all: Vec<Vec<f64>>,
}

impl Powers {
    fn new(curve: &[DVec3], axis: usize, n: usize) -> Self {
        let m = curve.len() - 1;
        let scaled = |value: &dyn Fn(&DVec3) -> f64| -> Vec<f64> {
            curve.iter().enumerate().map(|(i, p)| binomial(m, i) * value(p)).collect()
        };
        let (below, above) = (scaled(&|p| p.z - p[axis]), scaled(&|p| p[axis]));
        let powers = |of: &[f64]| {
            let mut all = vec![vec![1.0]];
            for i in 0..n {
                let mut next = vec![0.0; all[i].len() + m];
                add_product(&mut next, &all[i], of);
                all.push(next);
            }
            all
        };
        let (below, above) = (powers(&below), powers(&above));
        let all = (0..=n).map(|i| {
            let mut product = vec![0.0; m * n + 1];
            add_product(&mut product, &below[n - i], &above[i]);
            product.iter_mut().for_each(|x| *x *= binomial(n, i));
            product
        });
        Self { all: all.collect() }
    }

    fn degree(&self) -> usize {
        self.all[0].len() - 1
    }

    fn scaled_sum(&self, row: &[DVec2]) -> Vec<DVec2> {
        let mut sum = vec![DVec2::ZERO; self.degree() + 1];
        for (value, power) in row.iter().zip(&self.all) {
            sum.iter_mut().zip(power).for_each(|(sum, x)| *sum += *value * *x);
        }
        sum
    }

    fn sum(&self, row: &[DVec2]) -> Height {
        unscaled(self.scaled_sum(row))
    }
}

/// Adds `a * b`.
fn add_product<T: Copy + std::ops::AddAssign + std::ops::Mul<f64, Output = T>>(to: &mut [T], a: &[T], b: &[f64]) {
    for (i, x) in a.iter().enumerate() {
        to[i..].iter_mut().zip(b).for_each(|(sum, y)| *sum += *x * *y);
    }
}

/// Bernstein coefficients from coefficients scaled by binomials.
fn unscaled(scaled: Vec<DVec2>) -> Height {
    let degree = scaled.len() - 1;
    Net::build(degree, 0, |i, _| scaled[i] / binomial(degree, i))
}

fn de_casteljau(mut row: Vec<DVec2>, t: f64) -> DVec2 {
    for last in (0..row.len() - 1).rev() {
        for i in 0..=last {
            row[i] = row[i] * (1.0 - t) + row[i + 1] * t;
        }
    }
    row[0]
}

/// The control points of a curve in the domain, in the unit square over `u` and `v`.
pub(super) fn in_unit_square(points: &[DVec3], u: (f64, f64), v: (f64, f64)) -> Vec<DVec3> {
    let local = |p: &DVec3| {
        let q = p.point();
        DVec3::from_point(DVec2::new((q.x - u.0) / (u.1 - u.0), (q.y - v.0) / (v.1 - v.0)), p.z)
    };
    points.iter().map(local).collect()
}
