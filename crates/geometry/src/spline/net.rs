//! Tensor-product Bernstein polynomials multiplied out: exact nets of derivatives' numerators.
//!
//! ```text
//!   P, w ──du, dv──▶ P_u, w_u, …  ──times, minus──▶ A = P_u w - P w_u      as one net each: its hull bounds it,
//!                                                   A × B                  its corner is its Taylor series
//! ```
//!
//! Source: products from G. Farin, *Curves and Surfaces for CAGD*, 2002, section 6.10.

use super::{Control, Patch, binomial};
use glam::{DVec2, DVec3, DVec4};
use std::ops::{Add, Mul, Sub};

/// `P` and `w`, moved to the origin: derivatives do not change, and fewer digits cancel.
pub(super) fn nets(patch: &Patch) -> (Net<DVec3>, Net<f64>) {
    let centre = patch.points[patch.points.len() / 2].point();
    let (n, k) = (patch.degree_u, patch.degree_v);
    let position = Net { n, k, values: patch.points.iter().map(|&p: &DVec4| p.truncate() - centre * p.w).collect() };
    let weight = Net { n, k, values: patch.points.iter().map(|p| p.w).collect() };
    (position, weight)
}

/// A tensor-product Bernstein polynomial, `u` fastest.
#[derive(Clone)]
pub(crate) struct Net<T> {
    pub n: usize,
    pub k: usize,
    values: Vec<T>,
}

/// The coefficients of a net.
pub(crate) trait Value:
    Copy + Default + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self>
{
}
impl Value for f64 {}
impl Value for DVec2 {}
impl Value for DVec3 {}

impl<T: Value> Net<T> {
    pub fn at(&self, i: usize, j: usize) -> T {
        self.values[j * (self.n + 1) + i]
    }

    pub fn build(n: usize, k: usize, value: impl Fn(usize, usize) -> T) -> Self {
        let values = (0..=k).flat_map(|j| (0..=n).map(move |i| (i, j))).map(|(i, j)| value(i, j)).collect();
        Self { n, k, values }
    }

    /// A constant has degree 0 and derivative 0 of degree 0.
    pub fn du(&self) -> Self {
        if self.n == 0 {
            return Self::build(0, self.k, |_, _| T::default());
        }
        Self::build(self.n - 1, self.k, |i, j| (self.at(i + 1, j) - self.at(i, j)) * self.n as f64)
    }

    pub fn dv(&self) -> Self {
        if self.k == 0 {
            return Self::build(self.n, 0, |_, _| T::default());
        }
        Self::build(self.n, self.k - 1, |i, j| (self.at(i, j + 1) - self.at(i, j)) * self.k as f64)
    }

    pub fn scaled(&self, s: f64) -> Self {
        Self::build(self.n, self.k, |i, j| self.at(i, j) * s)
    }

    pub fn minus(&self, other: &Self) -> Self {
        debug_assert_eq!((self.n, self.k), (other.n, other.k), "numerators of equal degree");
        Self::build(self.n, self.k, |i, j| self.at(i, j) - other.at(i, j))
    }

    /// Row by row, `u` fastest.
    pub fn all(&self) -> &[T] {
        &self.values
    }

    /// The same function, of the same degree or a higher one.
    pub fn elevated(&self, n: usize, k: usize) -> Self {
        if (self.n, self.k) == (n, k) {
            return self.clone();
        }
        self.times(&Net::build(n - self.n, k - self.k, |_, _| 1.0))
    }

    /// The nets over both halves of the range of `u`.
    pub fn halves_u(mut self) -> [Self; 2] {
        let mut right = self.clone();
        for row in self.values.chunks_exact_mut(self.n + 1).zip(right.values.chunks_exact_mut(self.n + 1)) {
            halve(row.0, row.1);
        }
        [self, right]
    }

    /// The nets over both halves of the range of `v`.
    pub fn halves_v(mut self) -> [Self; 2] {
        let mut above = self.clone();
        let columns = self.n + 1;
        let mut column = vec![T::default(); self.k + 1];
        let mut other = column.clone();
        for i in 0..columns {
            (0..=self.k).for_each(|j| column[j] = self.at(i, j));
            halve(&mut column, &mut other);
            for j in 0..=self.k {
                self.values[j * columns + i] = column[j];
                above.values[j * columns + i] = other[j];
            }
        }
        [self, above]
    }

    /// Product with a scalar net: coefficient `m` of degree `n1 + n2` is
    /// `sum C(n1, a) C(n2, m - a) / C(n1 + n2, m) f_a g_{m-a}`, in each direction.
    pub fn times(&self, other: &Net<f64>) -> Self {
        let (n, k) = (self.n + other.n, self.k + other.k);
        let share = |n1: usize, n2: usize| -> Vec<Vec<f64>> {
            (0..=n1)
                .map(|a| {
                    (0..=n2).map(|b| binomial(n1, a) * binomial(n2, b) / binomial(n1 + n2, a + b)).collect::<Vec<_>>()
                })
                .collect()
        };
        let (in_u, in_v) = (share(self.n, other.n), share(self.k, other.k));
        let mut product = Self { n, k, values: vec![T::default(); (n + 1) * (k + 1)] };
        for (j1, shares_v) in in_v.iter().enumerate() {
            for (j2, &sv) in shares_v.iter().enumerate() {
                for (i1, shares_u) in in_u.iter().enumerate() {
                    let f = self.at(i1, j1) * sv;
                    for (i2, &su) in shares_u.iter().enumerate() {
                        let at = (j1 + j2) * (n + 1) + i1 + i2;
                        product.values[at] = product.values[at] + f * (su * other.at(i2, j2));
                    }
                }
            }
        }
        product
    }
}

/// De Casteljau's algorithm at 1/2: `row` becomes the coefficients over the first half, `other` those over the second.
fn halve<T: Value>(row: &mut [T], other: &mut [T]) {
    let n = row.len() - 1;
    for last in (0..=n).rev() {
        other[last] = row[n];
        // row[k] after k steps is a coefficient of the first half, and stays
        for i in (n - last + 1..=n).rev() {
            row[i] = (row[i - 1] + row[i]) * 0.5;
        }
    }
}

/// `A = P_u w - P w_u` and `B = P_v w - P w_v`: `S_u = A / w²`, `S_v = B / w²`. Where all weights are one number,
/// the derivatives of `P` alone, whose degrees are lower.
pub(super) fn numerators(patch: &Patch) -> (Net<DVec3>, Net<DVec3>) {
    let (position, weight) = nets(patch);
    if patch.is_polynomial() {
        return (position.du(), position.dv());
    }
    let along = |slope: Net<DVec3>, weight_slope: Net<f64>| slope.times(&weight).minus(&position.times(&weight_slope));
    (along(position.du(), weight.du()), along(position.dv(), weight.dv()))
}

impl Net<DVec3> {
    pub fn largest(&self) -> f64 {
        self.values.iter().map(|v| v.length()).fold(0.0, f64::max)
    }

    /// Cross product, coefficient by coefficient of the product net.
    pub fn cross(&self, other: &Self) -> Self {
        let [ax, ay, az] = self.components();
        let [bx, by, bz] = other.components();
        let part = |a: &Net<f64>, b: &Net<f64>, c: &Net<f64>, d: &Net<f64>| a.times(b).minus(&c.times(d));
        let (x, y, z) = (part(&ay, &bz, &az, &by), part(&az, &bx, &ax, &bz), part(&ax, &by, &ay, &bx));
        Net::build(x.n, x.k, |i, j| DVec3::new(x.at(i, j), y.at(i, j), z.at(i, j)))
    }

    fn components(&self) -> [Net<f64>; 3] {
        [0, 1, 2].map(|c| Net::build(self.n, self.k, |i, j| self.at(i, j)[c]))
    }
}
