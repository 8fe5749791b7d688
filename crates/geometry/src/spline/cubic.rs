//! The C² cubic spline through given values, its end conditions, and the surface through a grid of values.
//!
//! ```text
//!            d_1                    knots   t_0 t_0 t_0 t_0 t_1 … t_n t_n t_n t_n
//!          ●      ● d_2             one cubic between neighbours, two derivatives continuous
//!   d_0 ●            ╲      ● d_n
//!                      ● ──         left over: two equations, the end conditions
//!   t_0    t_1    t_2  …    t_n
//! ```
//!
//! A factored system serves any number of right sides, each in linear time. So grids of a million points are cheap.
//!
//! Source: C. de Boor, *A Practical Guide to Splines*, 2001, chapters IV and XVII (tensor products).

use super::Basis;
use crate::math::banded::{Banded, Factored, Singular};
use rayon::prelude::*;
use std::ops::{Add, Mul, Sub};

/// The end conditions: two equations that the values leave open.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ends {
    /// No bending at the ends: second derivative 0. Error `O(h²)` there.
    Natural,
    /// The two first and the two last spans are one cubic each: error `O(h⁴)` throughout. With 3 values the
    /// parabola through them, with 2 the line.
    NotAKnot,
    /// First derivatives given.
    Clamped,
    /// Value, first and second derivative agree at both ends; the last value must be the first one.
    Periodic,
}

/// Values that can be interpolated: numbers and vectors.
pub trait Linear:
    Copy + Default + PartialEq + Add<Output = Self> + Sub<Output = Self> + Mul<f64, Output = Self> + Send + Sync
{
}
impl<T> Linear for T where
    T: Copy + Default + PartialEq + Add<Output = T> + Sub<Output = T> + Mul<f64, Output = T> + Send + Sync
{
}

/// Interpolation at fixed parameters, ready for many right sides.
#[derive(Clone, Debug)]
pub struct Cubic {
    degree: usize,
    knots: Vec<f64>,
    ends: Ends,
    system: Factored,
    /// Periodic: the spline of zero values with slope 1 at both ends, and `1 / (φ''(t_0) - φ''(t_n))`.
    bridge: Option<(Vec<f64>, f64)>,
    /// Second derivatives of the first and last control points at the ends.
    bends: [Vec<f64>; 2],
}

impl Cubic {
    /// For values at `parameters`, which increase strictly; at least 2, for [`Ends::Periodic`] 3.
    ///
    /// # Errors
    /// [`Singular`] when the parameters are so uneven that rounding leaves no solution.
    ///
    /// # Panics
    /// When there are fewer parameters.
    pub fn new(parameters: &[f64], ends: Ends) -> Result<Self, Singular> {
        let t = parameters;
        let n = t.len();
        assert!(n >= 2 && (ends != Ends::Periodic || n >= 3), "enough parameters for the end conditions");
        let (first, last) = (t[0], t[n - 1]);
        let free = ends == Ends::NotAKnot;
        let degree = if free { 3.min(n - 1) } else { 3 };
        let inner = match (free, degree) {
            (false, _) => &t[1..n - 1],
            (true, 3) => &t[2..n - 2],
            _ => &[],
        };
        let edge = |x: f64| std::iter::repeat_n(x, degree + 1);
        let knots: Vec<f64> = edge(first).chain(inner.iter().copied()).chain(edge(last)).collect();
        let count = knots.len() - degree - 1;
        let mut matrix = Banded::new(count, 2, 2);
        let put = |matrix: &mut Banded, row: usize, at: f64, order: usize| {
            let b = Basis::new(degree, &knots, count, at);
            // equations of curvature are scaled to the size of the others
            let size = b.derivatives(order).iter().fold(0.0f64, |m, x| m.max(x.abs()));
            for (k, x) in b.derivatives(order).iter().enumerate().filter(|(_, x)| **x != 0.0) {
                matrix.add(row, b.first + k, x / if order == 0 { 1.0 } else { size });
            }
        };
        let shift = usize::from(!free);
        for (i, x) in t.iter().enumerate().take(n - 1).skip(1) {
            put(&mut matrix, i + shift, *x, 0);
        }
        matrix.add(0, 0, 1.0);
        matrix.add(count - 1, count - 1, 1.0);
        match ends {
            Ends::NotAKnot => {}
            Ends::Natural => {
                put(&mut matrix, 1, first, 2);
                put(&mut matrix, count - 2, last, 2);
            }
            // P_1 - P_0 = slope h / 3
            Ends::Clamped | Ends::Periodic => {
                for (row, neighbour) in [(1, 0), (count - 2, count - 1)] {
                    matrix.add(row, row, 1.0);
                    matrix.add(row, neighbour, -1.0);
                }
            }
        }
        let bends = [first, last].map(|x| Basis::new(degree, &knots, count, x).derivatives(2).to_vec());
        let mut this = Self { degree, knots, ends, system: matrix.factor()?, bridge: None, bends };
        if ends == Ends::Periodic {
            let phi = this.fill(&vec![0.0; n], 1.0, 1.0);
            let [start, end] = this.bend(&phi);
            this.bridge = Some((phi, 1.0 / (start - end)));
        }
        Ok(this)
    }

    /// 3, or less where there are too few values.
    pub fn degree(&self) -> usize {
        self.degree
    }

    /// The knot vector, clamped.
    pub fn knots(&self) -> &[f64] {
        &self.knots
    }

    /// Control points.
    pub fn count(&self) -> usize {
        self.knots.len() - self.degree - 1
    }

    /// Values that [`Cubic::control`] takes.
    pub fn value_count(&self) -> usize {
        self.count() - if self.ends == Ends::NotAKnot { 0 } else { 2 }
    }

    /// Control points of the spline through `values`; the first and the last are the end values, bit for bit.
    /// `slopes` are the first derivatives at the ends, used by [`Ends::Clamped`] alone.
    ///
    /// # Panics
    /// When `values` is not [`Cubic::value_count`] long.
    pub fn control<T: Linear>(&self, values: &[T], slopes: (T, T)) -> Vec<T> {
        assert_eq!(values.len(), self.value_count(), "one value a parameter");
        let clamped = self.ends == Ends::Clamped;
        let (start, end) = if clamped { slopes } else { (T::default(), T::default()) };
        let mut out = self.fill(values, start, end);
        if let Some((phi, scale)) = &self.bridge {
            let [a, b] = self.bend(&out);
            let slope = (b - a) * *scale;
            for (p, f) in out.iter_mut().zip(phi) {
                *p = *p + slope * *f;
            }
        }
        let last = out.len() - 1;
        (out[0], out[last]) = (values[0], values[values.len() - 1]);
        out
    }

    /// Solves with the given values and end slopes.
    fn fill<T: Linear>(&self, values: &[T], start: T, end: T) -> Vec<T> {
        let (n, count) = (values.len(), self.count());
        let mut b = vec![T::default(); count];
        let shift = usize::from(self.ends != Ends::NotAKnot);
        b[shift..n + shift].copy_from_slice(values);
        if shift == 1 {
            (b[0], b[count - 1]) = (values[0], values[n - 1]);
            let third = |a: f64, b: f64| (b - a) / 3.0;
            let k = &self.knots;
            b[1] = start * third(k[3], k[4]);
            b[count - 2] = end * -third(k[count - 1], k[count]);
        }
        self.system.solve(&mut b);
        b
    }

    /// Second derivatives at both ends.
    fn bend<T: Linear>(&self, control: &[T]) -> [T; 2] {
        let sum =
            |weights: &[f64], points: &[T]| weights.iter().zip(points).fold(T::default(), |s, (w, p)| s + *p * *w);
        let n = control.len();
        [sum(&self.bends[0], &control[..=self.degree]), sum(&self.bends[1], &control[n - self.degree - 1..])]
    }
}

/// Control net of the surface through `values[j * value_count_u + i]`; `u` fastest in both. Slopes of clamped ends
/// are 0.
///
/// # Panics
/// When the number of values does not fit.
pub fn tensor<T: Linear>(u: &Cubic, v: &Cubic, values: &[T]) -> Vec<T> {
    let (mu, mv) = (u.value_count(), v.value_count());
    assert_eq!(values.len(), mu * mv, "one value at each pair of parameters");
    let zero = (T::default(), T::default());
    let rows: Vec<Vec<T>> = values.par_chunks(mu).map(|row| u.control(row, zero)).collect();
    let (nu, nv) = (u.count(), v.count());
    let columns: Vec<Vec<T>> = (0..nu)
        .into_par_iter()
        .map(|i| {
            let column: Vec<T> = rows.iter().map(|row| row[i]).collect();
            v.control(&column, zero)
        })
        .collect();
    (0..nv).flat_map(|j| columns.iter().map(move |c| c[j])).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn value(c: &Cubic, control: &[f64], t: f64, order: usize) -> f64 {
        let b = Basis::new(c.degree(), c.knots(), c.count(), t);
        b.derivatives(order).iter().enumerate().map(|(k, x)| x * control[b.first + k]).sum()
    }

    const UNEVEN: [f64; 7] = [-1.0, -0.6, 0.3, 0.5, 1.4, 1.5, 3.0];

    /// A cubic is its own interpolant wherever the end conditions hold for it.
    #[test]
    fn cubics_come_back() {
        let f = |t: f64| 2.0 - t + 0.5 * t * t - 0.25 * t * t * t;
        let slope = |t: f64| -1.0 + t - 0.75 * t * t;
        let values: Vec<f64> = UNEVEN.iter().map(|t| f(*t)).collect();
        for ends in [Ends::NotAKnot, Ends::Clamped] {
            let c = Cubic::new(&UNEVEN, ends).unwrap();
            let p = c.control(&values, (slope(-1.0), slope(3.0)));
            for step in 0..=80 {
                let t = -1.0 + f64::from(step) * 0.05;
                assert!((value(&c, &p, t, 0) - f(t)).abs() < 1e-13, "{ends:?} at {t}");
            }
        }
        // lines have no bending
        let c = Cubic::new(&UNEVEN, Ends::Natural).unwrap();
        let p = c.control(&UNEVEN.map(|t| 3.0 * t - 1.0), (0.0, 0.0));
        assert!((value(&c, &p, 2.2, 0) - 5.6).abs() < 1e-13);
    }

    #[test]
    fn few_values() {
        for n in 2..=5 {
            let t = &UNEVEN[..n];
            let f = |t: f64| t.powi(n as i32 - 1).min(t * t * t);
            let c = Cubic::new(t, Ends::NotAKnot).unwrap();
            assert_eq!(c.degree(), 3.min(n - 1));
            let values: Vec<f64> = t.iter().map(|t| f(*t)).collect();
            let p = c.control(&values, (0.0, 0.0));
            for (t, x) in t.iter().zip(&values) {
                assert!((value(&c, &p, *t, 0) - x).abs() < 1e-14);
            }
        }
    }

    #[test]
    fn natural_and_periodic_ends() {
        let mut values = [0.0, 2.0, -1.0, 0.5, 0.25, 3.0, 0.0];
        values[6] = values[0];
        let c = Cubic::new(&UNEVEN, Ends::Natural).unwrap();
        let p = c.control(&values, (0.0, 0.0));
        assert!(value(&c, &p, -1.0, 2).abs() < 1e-11 && value(&c, &p, 3.0, 2).abs() < 1e-11);
        let c = Cubic::new(&UNEVEN, Ends::Periodic).unwrap();
        let p = c.control(&values, (0.0, 0.0));
        assert_eq!(p[0], p[p.len() - 1]);
        for order in [1, 2] {
            let (a, b) = (value(&c, &p, -1.0, order), value(&c, &p, 3.0, order));
            assert!((a - b).abs() < 1e-12 * a.abs().max(10.0), "order {order}: {a} {b}");
        }
        for (t, x) in UNEVEN.iter().zip(&values) {
            assert!((value(&c, &p, *t, 0) - x).abs() < 1e-13);
        }
    }

    /// de Boor's bound for C² cubics on an even grid: the error falls as `h⁴`.
    #[test]
    fn fourth_order() {
        let error = |n: usize, ends: Ends| {
            let t: Vec<f64> = (0..=n).map(|i| i as f64 / n as f64 * std::f64::consts::TAU).collect();
            let c = Cubic::new(&t, ends).unwrap();
            let mut values: Vec<f64> = t.iter().map(|t| t.sin()).collect();
            values[n] = values[0];
            let p = c.control(&values, (1.0, 1.0));
            (0..1000).map(|i| i as f64 * 0.00628).map(|t| (value(&c, &p, t, 0) - t.sin()).abs()).fold(0.0, f64::max)
        };
        for ends in [Ends::NotAKnot, Ends::Clamped, Ends::Periodic] {
            let ratio = error(20, ends) / error(40, ends);
            assert!(ratio > 13.0, "{ends:?}: {ratio}");
        }
    }
}
