//! Least squares: few control points near many data.
//!
//! Along one parameter the normal equations `Nᵀ N P = Nᵀ D` of the cubic B-splines are banded, three entries on
//! either side, whatever the number of data. A grid is done one parameter after the other, which is the least-squares
//! solution of the whole grid.
//!
//! Knots are placed so that every span holds about the same number of data: the equations then always have a
//! solution (Schoenberg, Whitney).

use super::{GridFit, PointGrid, polynomial};
use crate::construct::ConstructError;
use crate::math::banded::{Banded, Factored};
use crate::spline::Basis;
use glam::DVec3;
use rayon::prelude::*;

const DEGREE: usize = 3;

/// Least squares along one parameter; the first and the last datum are met exactly.
struct Squares {
    knots: Vec<f64>,
    count: usize,
    bases: Vec<Basis>,
    /// Normal equations of the inner control points.
    system: Option<Factored>,
}

impl Squares {
    fn new(parameters: &[f64], count: usize) -> Result<Self, ConstructError> {
        let knots = placed(parameters, count);
        let bases: Vec<Basis> = parameters.iter().map(|t| Basis::new(DEGREE, &knots, count, *t)).collect();
        let inner = count - 2;
        let mut matrix = Banded::new(inner, DEGREE, DEGREE);
        for b in &bases[1..bases.len() - 1] {
            for (r, x) in b.values().iter().enumerate() {
                for (c, y) in b.values().iter().enumerate() {
                    let (i, j) = (b.first + r, b.first + c);
                    if (1..=inner).contains(&i) && (1..=inner).contains(&j) {
                        matrix.add(i - 1, j - 1, x * y);
                    }
                }
            }
        }
        let system = if inner > 0 { Some(matrix.factor()?) } else { None };
        Ok(Self { knots, count, bases, system })
    }

    fn solve(&self, data: &[DVec3]) -> Vec<DVec3> {
        let (first, last) = (data[0], data[data.len() - 1]);
        let mut out = vec![DVec3::ZERO; self.count];
        for (b, d) in self.bases.iter().zip(data).take(data.len() - 1).skip(1) {
            let mut rest = *d;
            for (r, x) in b.values().iter().enumerate() {
                if b.first + r == 0 {
                    rest -= first * *x;
                } else if b.first + r == self.count - 1 {
                    rest -= last * *x;
                }
            }
            for (r, x) in b.values().iter().enumerate() {
                out[b.first + r] += rest * *x;
            }
        }
        if let Some(system) = &self.system {
            system.solve(&mut out[1..self.count - 1]);
        }
        (out[0], out[self.count - 1]) = (first, last);
        out
    }
}

/// A clamped knot vector for `count` control points whose spans hold equal shares of the data.
fn placed(parameters: &[f64], count: usize) -> Vec<f64> {
    let (first, last) = (parameters[0], parameters[parameters.len() - 1]);
    let spans = count - DEGREE;
    let share = parameters.len() as f64 / spans as f64;
    let inner = (1..spans).map(|j| {
        // Piegl, Tiller (9.68) and (9.69)
        let at = j as f64 * share;
        let (i, a) = (at as usize, at.fract());
        (1.0 - a) * parameters[i - 1] + a * parameters[i]
    });
    let edge = |x: f64| std::iter::repeat_n(x, DEGREE + 1);
    edge(first).chain(inner).chain(edge(last)).collect()
}

/// The least-squares bicubic spline to the grid, with `controls` control points along `u` and `v`; the four corners are
/// met exactly, and each side is the least-squares curve to its data.
///
/// Sides that meet stay together, without a promise of smoothness there.
///
/// # Errors
/// Fewer than 4 control points along a parameter or more than data; data that coincide.
pub fn approximate(grid: &PointGrid, controls: (usize, usize)) -> Result<GridFit, ConstructError> {
    let (nu, nv) = grid.counts();
    for (what, asked, data) in [("control points in u", controls.0, nu), ("control points in v", controls.1, nv)] {
        if asked < DEGREE + 1 {
            return Err(ConstructError::TooFew { what, got: asked, needed: DEGREE + 1 });
        }
        if asked > data {
            return Err(ConstructError::TooMany { what, got: asked, most: data });
        }
    }
    let (us, vs) = (grid.chord_lengths(0)?, grid.chord_lengths(1)?);
    let (su, sv) = (Squares::new(&us, controls.0)?, Squares::new(&vs, controls.1)?);
    let mut values = grid.points.clone();
    grid.tie(&mut values, nu);
    let rows: Vec<Vec<DVec3>> = values.par_chunks(nu).map(|row| su.solve(row)).collect();
    let column = |i: usize| sv.solve(&rows.iter().map(|row| row[i]).collect::<Vec<_>>());
    let columns: Vec<Vec<DVec3>> = (0..controls.0).into_par_iter().map(column).collect();
    let mut net: Vec<DVec3> = (0..controls.1).flat_map(|j| columns.iter().map(move |c| c[j])).collect();
    grid.tie(&mut net, controls.0);
    let surface = polynomial((DEGREE, DEGREE), &su.knots, &sv.knots, &net)?;
    let error = grid.error(&surface, &us, &vs);
    Ok(GridFit { surface, parameters_u: us, parameters_v: vs, error })
}
