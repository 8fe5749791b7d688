//! Surfaces from data: through a grid of points, or near it.
//!
//! ```text
//!    ●───●──●─────●   row v_2         interpolate: C² bicubic through every point
//!    │   │  │     │                   approximate: fewer control points, least squares,
//!    ●───●──●─────●   row v_1                      corners met exactly
//!    │   │  │     │
//!    ●───●──●─────●   row v_0         points[j * count_u + i], i along u
//!   u_0 u_1 u_2  u_3
//! ```
//!
//! Parameters are chord lengths, averaged over the rows (columns) that have a length; a row that is one point is a pole
//! and does not count. Sides that meet, point by point, are closed smoothly; poles and seams end up as the same
//! numbers.
//!
//! Cost: linear in the number of points; every row and column is a banded system that is factored once.
//!
//! Sources: L. Piegl, W. Tiller, *The NURBS Book*, 1997, sections 9.2.5 and 9.4.3; C. de Boor, *A Practical Guide to
//! Splines*, 2001, chapters XIV and XVII.

mod approximate;
mod height;

pub use approximate::approximate;
pub use height::{HeightField, height_field};

use super::ConstructError;
use crate::spline::cubic::{Cubic, Ends, tensor};
use crate::spline::{Basis, Surface};
use glam::{DVec3, DVec4};
use rayon::prelude::*;

/// Most points of a grid: 4096 x 4096.
pub const MOST_POINTS: usize = 1 << 24;
/// Neighbours (in the mean over all rows) closer than this share of the largest coordinate coincide.
const SAME: f64 = 1e-14;

/// A rectangular grid of points, `u` fastest.
#[derive(Clone, Debug, PartialEq)]
pub struct PointGrid {
    count_u: usize,
    points: Vec<DVec3>,
}

/// Distances between the data and the surface at the data's parameters, in model units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GridError {
    /// The largest.
    pub most: f64,
    /// The root of the mean square.
    pub rms: f64,
}

/// A surface made from data.
#[derive(Clone, Debug, PartialEq)]
pub struct GridFit {
    /// The bicubic spline (of lower degree along a parameter with fewer than 4 points).
    pub surface: Surface,
    /// Parameters of the columns.
    pub parameters_u: Vec<f64>,
    /// Parameters of the rows.
    pub parameters_v: Vec<f64>,
    /// Distances of the data from the surface; rounding after interpolation.
    pub error: GridError,
}

impl PointGrid {
    /// Rows of `count_u` points.
    ///
    /// # Errors
    /// Fewer than 2 x 2 points, more than 2^24, rows that are not full, a point that is not finite.
    pub fn new(count_u: usize, points: Vec<DVec3>) -> Result<Self, ConstructError> {
        if count_u < 2 {
            return Err(ConstructError::TooFew { what: "points in a row", got: count_u, needed: 2 });
        }
        let rows = points.len().div_ceil(count_u);
        if rows * count_u != points.len() {
            return Err(ConstructError::Count { what: "points", got: points.len(), needed: rows * count_u });
        }
        if rows < 2 {
            return Err(ConstructError::TooFew { what: "rows of points", got: rows, needed: 2 });
        }
        if points.len() > MOST_POINTS {
            return Err(ConstructError::TooMany { what: "points", got: points.len(), most: MOST_POINTS });
        }
        if let Some(i) = points.iter().position(|p| !(p.is_finite() && p.abs().max_element() < 1e150)) {
            return Err(ConstructError::PointNotFinite { row: i / count_u, column: i % count_u });
        }
        Ok(Self { count_u, points })
    }

    /// Points along `u` and `v`.
    pub fn counts(&self) -> (usize, usize) {
        (self.count_u, self.points.len() / self.count_u)
    }

    /// All points, `u` fastest.
    pub fn points(&self) -> &[DVec3] {
        &self.points
    }

    fn size(&self) -> f64 {
        self.points.iter().map(|p| p.abs().max_element()).fold(0.0, f64::max)
    }

    /// Chord-length parameters of the columns (`axis` 0) or rows (1), averaged, from 0 to the mean length.
    fn chord_lengths(&self, axis: usize) -> Result<Vec<f64>, ConstructError> {
        let (nu, nv) = self.counts();
        let (count, lines) = if axis == 0 { (nu, nv) } else { (nv, nu) };
        let (step, stride) = if axis == 0 { (1, nu) } else { (nu, 1) };
        let same = SAME * self.size();
        let mut sums = vec![0.0; count - 1];
        let (mut used, mut total) = (0usize, 0.0);
        for line in 0..lines {
            let at = |i: usize| self.points[line * stride + i * step];
            let length: f64 = (1..count).map(|i| at(i).distance(at(i - 1))).sum();
            if length > same {
                (used, total) = (used + 1, total + length);
                for (i, sum) in sums.iter_mut().enumerate() {
                    *sum += at(i + 1).distance(at(i)) / length;
                }
            }
        }
        let what = if axis == 0 { "every row of the grid" } else { "every column of the grid" };
        if used == 0 {
            return Err(ConstructError::ZeroLength { what });
        }
        // at least a parameter that differs after rounding
        if let Some(first) = sums.iter().position(|s| *s <= 1e-12 * used as f64) {
            return Err(ConstructError::CoincidentPoints { first, second: first + 1 });
        }
        let scale = total / (used * used) as f64;
        let mut at = 0.0;
        Ok(std::iter::once(0.0)
            .chain(sums.iter().map(|s| {
                at += s * scale;
                at
            }))
            .collect())
    }

    /// First and last column (`axis` 0) or row meet point by point, within rounding, and are no pole.
    fn closed(&self, axis: usize) -> bool {
        let (nu, nv) = self.counts();
        let same = 1e-12 * self.size();
        let pair = |i: usize| {
            if axis == 0 {
                (self.points[i * nu], self.points[i * nu + nu - 1])
            } else {
                (self.points[i], self.points[(nv - 1) * nu + i])
            }
        };
        let (count, lines) = if axis == 0 { (nu, nv) } else { (nv, nu) };
        let first = pair(0).0;
        count > 3
            && (0..lines).all(|i| pair(i).0.distance(pair(i).1) <= same)
            && (0..lines).any(|i| pair(i).0.distance(first) > same)
    }

    /// Makes poles and seams of a control net of `width` columns the same numbers as in the data.
    fn tie(&self, net: &mut [DVec3], width: usize) {
        let (nu, nv) = self.counts();
        if self.closed(0) {
            net.chunks_exact_mut(width).for_each(|row| row[width - 1] = row[0]);
        }
        let height = net.len() / width;
        if self.closed(1) {
            net.copy_within(0..width, (height - 1) * width);
        }
        for (data, at) in [(0, 0), (nv - 1, height - 1)] {
            let row = &self.points[data * nu..][..nu];
            if row.iter().all(|p| *p == row[0]) {
                net[at * width..][..width].fill(row[0]);
            }
        }
        for (data, at) in [(0, 0), (nu - 1, width - 1)] {
            let first = self.points[data];
            if (0..nv).all(|j| self.points[j * nu + data] == first) {
                net.iter_mut().skip(at).step_by(width).for_each(|p| *p = first);
            }
        }
    }

    /// Distances to `surface` at the parameters.
    fn error(&self, surface: &Surface, us: &[f64], vs: &[f64]) -> GridError {
        let ((ku, kv), (nu, nv), (pu, pv)) = (surface.knots(), surface.counts(), surface.degrees());
        let columns: Vec<Basis> = us.iter().map(|u| Basis::new(pu, ku, nu, *u)).collect();
        let row = |(v, data): (&f64, &[DVec3])| {
            let b = Basis::new(pv, kv, nv, *v);
            let mut line = vec![DVec3::ZERO; nu];
            for (j, y) in b.values().iter().enumerate() {
                let points = &surface.points()[(b.first + j) * nu..][..nu];
                line.iter_mut().zip(points).for_each(|(s, p)| *s += p.truncate() * *y);
            }
            let squares = columns.iter().zip(data).map(|(a, p)| {
                let at = a.values().iter().zip(&line[a.first..]).fold(DVec3::ZERO, |s, (x, q)| s + *q * *x);
                at.distance_squared(*p)
            });
            squares.fold((0.0f64, 0.0), |(most, sum), d| (most.max(d), sum + d))
        };
        let rows: Vec<(f64, f64)> = vs.par_iter().zip(self.points.par_chunks(self.count_u)).map(row).collect();
        let (most, sum) = rows.iter().fold((0.0f64, 0.0), |(m, s), r| (m.max(r.0), s + r.1));
        GridError { most: most.sqrt(), rms: (sum / self.points.len() as f64).sqrt() }
    }
}

/// The C² bicubic spline through every point of the grid.
///
/// Sides that meet are closed with two continuous derivatives; elsewhere the ends are *not a knot*. The corners, and
/// points on clamped sides, are met bit for bit, the others within rounding.
///
/// # Errors
/// Neighbouring rows or columns that coincide, by index; grids without length.
pub fn interpolate(grid: &PointGrid) -> Result<GridFit, ConstructError> {
    interpolate_at(grid, grid.chord_lengths(0)?, grid.chord_lengths(1)?)
}

/// As [`interpolate`], with parameters that increase.
///
/// # Errors
/// Parameters that do not increase or do not fit the grid.
pub fn interpolate_at(grid: &PointGrid, us: Vec<f64>, vs: Vec<f64>) -> Result<GridFit, ConstructError> {
    let (nu, nv) = grid.counts();
    for (what, t, needed) in [("parameters in u", &us, nu), ("parameters in v", &vs, nv)] {
        if t.len() != needed {
            return Err(ConstructError::Count { what, got: t.len(), needed });
        }
        let bad = (0..needed).find(|i| !t[*i].is_finite() || (*i > 0 && t[*i] <= t[*i - 1]));
        if let Some(index) = bad {
            return Err(ConstructError::Order { what, index });
        }
    }
    let system =
        |t: &[f64], axis: usize| Cubic::new(t, if grid.closed(axis) { Ends::Periodic } else { Ends::NotAKnot });
    let (cu, cv) = (system(&us, 0)?, system(&vs, 1)?);
    let mut values = grid.points.clone();
    grid.tie(&mut values, nu);
    let mut net = tensor(&cu, &cv, &values);
    grid.tie(&mut net, cu.count());
    let surface = polynomial((cu.degree(), cv.degree()), cu.knots(), cv.knots(), &net)?;
    let error = grid.error(&surface, &us, &vs);
    Ok(GridFit { surface, parameters_u: us, parameters_v: vs, error })
}

/// A surface with weights 1.
fn polynomial(
    degrees: (usize, usize),
    knots_u: &[f64],
    knots_v: &[f64],
    net: &[DVec3],
) -> Result<Surface, ConstructError> {
    let points: Vec<DVec4> = net.iter().map(|p| p.extend(1.0)).collect();
    Ok(Surface::new(degrees, knots_u.to_vec(), knots_v.to_vec(), points)?)
}
