//! Surfaces over pictures of heights.
//!
//! ```text
//!      y1 ┌─────────┐ first row of the picture      65535 ─▶ z1
//!         │         │                                   0 ─▶ z0
//!      y0 └─────────┘ last row
//!        x0         x1
//! ```

use super::{GridFit, PointGrid, interpolate_at};
use crate::construct::ConstructError;
use glam::DVec3;

/// Where a picture of heights lies in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeightField {
    /// Samples in a row.
    pub width: usize,
    /// `x` of the first and the last column.
    pub x: (f64, f64),
    /// `y` of the last and the first row: pictures begin at the top.
    pub y: (f64, f64),
    /// `z` of 0 and of 65,535.
    pub z: (f64, f64),
}

/// The C² bicubic surface through 16-bit samples, row by row from the top; parameters are `x` and `y`, so that the
/// surface is a graph and the samples lie at their own parameters.
///
/// # Errors
/// Fewer than 2 x 2 samples, a last row that is not full, an extent that is empty or not finite.
pub fn height_field(samples: &[u16], field: &HeightField) -> Result<GridFit, ConstructError> {
    for (what, (a, b)) in [("the extent in x", field.x), ("the extent in y", field.y)] {
        if !(a.is_finite() && b.is_finite() && b - a > 1e-9 * a.abs().max(b.abs())) {
            return Err(ConstructError::Range { what, value: b - a, must: "positive" });
        }
    }
    if !(field.z.0.is_finite() && field.z.1.is_finite()) {
        return Err(ConstructError::NotFinite { what: "the range of heights" });
    }
    let width = field.width;
    if width < 2 || samples.len() < 2 * width {
        let got = if width < 2 { width } else { samples.len() / width };
        return Err(ConstructError::TooFew { what: "rows or columns of heights", got, needed: 2 });
    }
    let rows = samples.len() / width;
    if rows * width != samples.len() {
        let needed = (rows + 1) * width;
        return Err(ConstructError::Count { what: "heights", got: samples.len(), needed });
    }
    let even = |(a, b): (f64, f64), n: usize| -> Vec<f64> {
        (0..n).map(|i| if i + 1 == n { b } else { a + (b - a) * (i as f64 / (n - 1) as f64) }).collect()
    };
    let (xs, ys) = (even(field.x, width), even(field.y, rows));
    let height = |s: u16| field.z.0 + (field.z.1 - field.z.0) * (f64::from(s) / f64::from(u16::MAX));
    let points = samples.chunks(width).rev().zip(&ys);
    let points = points.flat_map(|(row, y)| row.iter().zip(&xs).map(move |(s, x)| DVec3::new(*x, *y, height(*s))));
    interpolate_at(&PointGrid::new(width, points.collect())?, xs, ys)
}
