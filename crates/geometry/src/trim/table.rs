//! The u-intercept table of one face: the reference for the GPU's table.
//!
//! ```text
//!   v ▲
//!     │ strip 1   ────────●═══════●────────   row 4    one row per scan line: the u where a point
//!     │ mu = 2    ───●══════════════════●──   row 3    that moves right enters or leaves the face
//!  nu_1 ┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄┄
//!     │ strip 0   ───●═════●     ●═══════●─   row 2    [u0, u1, u2, u3]
//!     │ mu = 3    ────●═══●       ●═════●──   row 1
//!     │           ─────────────────────────   row 0    []
//!     └────────────────────────────────────▶ u
//! ```
//!
//! The domain's `v` range is cut into equal strips, strip `i` into `mu_i` equal cells, and a cell is sampled at its
//! centre: the row of a point is the nearest one. Curves are replaced by chords; each chord writes its `u` into every
//! row it crosses (bottom-open, top-closed). Each row is sorted, and its winding numbers become in/out transitions. So
//! a reader of the row needs no special case for duplicated, overlapping or wrongly nested loops.
//!
//! Source: R. Wu, J. Peters, *Correct resolution rendering of trimmed spline surfaces*, 2014, with
//! rows at cell centres instead of cell bottoms (halves the largest displacement) and winding
//! numbers instead of parity.

use super::{climbs, polyline};
use crate::model::TrimLoop;
use crate::spline::{Bezier, Control};
use glam::{DVec2, DVec3};

/// In/out transitions of one face on its scan lines.
#[derive(Clone, Debug, PartialEq)]
pub struct TrimTable {
    v: (f64, f64),
    /// First row of each strip, and the number of rows.
    base: Vec<usize>,
    /// Ordinate of each row, ascending.
    row_v: Vec<f64>,
    /// Range of each row in `flips`: `first[i]..first[i + 1]`.
    first: Vec<usize>,
    flips: Vec<f64>,
    /// No loop at all: the whole domain.
    whole: bool,
}

impl TrimTable {
    /// Fills the table.
    ///
    /// * `v`: the domain's parameter range, `v.0 < v.1`; it is cut into `densities.len()` strips.
    /// * `densities`: rows of each strip, `mu_i`; 0 counts as 1, for a strip without a row would
    ///   have no answer. At least one strip is made.
    /// * `segments`: chords of a curve, for example by [`segment_count`](super::segment_count).
    pub fn new(loops: &[TrimLoop], v: (f64, f64), densities: &[u32], segments: impl Fn(&Bezier<DVec3>) -> u32) -> Self {
        let (base, row_v) = scan_lines(v, densities);
        let mut crossings: Vec<Vec<(f64, i32)>> = vec![Vec::new(); row_v.len()];
        for curves in loops.iter().map(|l| l.curves().collect::<Vec<_>>()) {
            let Some(last) = curves.last() else { continue };
            let mut from = last.points[last.degree()].point();
            for curve in &curves {
                for to in polyline(curve, segments(curve)).skip(1) {
                    insert(&row_v, &mut crossings, from, to);
                    from = to;
                }
            }
        }
        let mut first = vec![0];
        let mut flips = Vec::new();
        for row in &mut crossings {
            resolve(row, &mut flips);
            first.push(flips.len());
        }
        Self { v, base, row_v, first, flips, whole: loops.is_empty() }
    }

    /// Rows of all strips.
    pub fn row_count(&self) -> usize {
        self.row_v.len()
    }

    /// The scan line of row `row`.
    pub fn row_v(&self, row: usize) -> f64 {
        self.row_v[row]
    }

    /// Ascending `u` at which row `row` enters and leaves the face, in turn; even in number.
    pub fn row(&self, row: usize) -> &[f64] {
        &self.flips[self.first[row]..self.first[row + 1]]
    }

    /// The row whose cell holds `v`; the first or last one for a `v` outside the domain.
    pub fn row_of(&self, v: f64) -> usize {
        let strips = self.base.len() - 1;
        let x = (v - self.v.0) / (self.v.1 - self.v.0) * strips as f64;
        let strip = (x.max(0.0) as usize).min(strips - 1); // the cast saturates, and drops a NaN to 0
        let rows = self.base[strip + 1] - self.base[strip];
        let j = ((x - strip as f64) * rows as f64).max(0.0) as usize;
        self.base[strip] + j.min(rows - 1)
    }

    /// Whether `(u, v)` belongs to the face, decided on the nearest scan line.
    pub fn contains(&self, u: f64, v: f64) -> bool {
        self.whole || self.row(self.row_of(v)).partition_point(|&flip| flip <= u) % 2 == 1
    }
}

/// First row of each strip with the total at the end, and the scan line of each row.
fn scan_lines((v0, v1): (f64, f64), densities: &[u32]) -> (Vec<usize>, Vec<f64>) {
    let densities = if densities.is_empty() { &[1] } else { densities };
    let strips = densities.len() as f64;
    let mut base = vec![0];
    let mut row_v = Vec::new();
    for (i, &density) in densities.iter().enumerate() {
        let rows = density.max(1);
        row_v.extend((0..rows).map(|j| {
            let x = i as f64 + (f64::from(j) + 0.5) / f64::from(rows);
            v0 + (v1 - v0) * (x / strips)
        }));
        base.push(row_v.len());
    }
    (base, row_v)
}

/// Writes the chord's `u` and direction into every row that it crosses.
///
/// The chord is evaluated from the end nearer to the scan line, whatever its direction: exact at
/// both ends and on vertical chords, and two loops that share an edge write the same `u` bit for
/// bit, and cancel.
fn insert(row_v: &[f64], crossings: &mut [Vec<(f64, i32)>], from: DVec2, to: DVec2) {
    let (lo, hi) = if from.y <= to.y { (from, to) } else { (to, from) };
    let first = row_v.partition_point(|&v| v <= lo.y);
    let end = row_v.partition_point(|&v| v <= hi.y);
    for (&v, row) in row_v[first..end].iter().zip(&mut crossings[first..end]) {
        let (below, above, height) = (v - lo.y, hi.y - v, hi.y - lo.y);
        let width = hi.x - lo.x;
        let u = if below < above { lo.x + width * (below / height) } else { hi.x - width * (above / height) };
        row.push((u, climbs(from.y, to.y, v)));
    }
}

/// Sorts one row and appends the `u` where the winding number becomes zero or ceases to be.
///
/// Crossings at the same `u` act together, in whatever order they were written.
fn resolve(row: &mut [(f64, i32)], flips: &mut Vec<f64>) {
    row.sort_unstable_by(|a, b| a.0.total_cmp(&b.0));
    let mut winding = 0; // far left of everything; a climbing curve has the winding one less on its right
    for group in row.chunk_by(|a, b| a.0 == b.0) {
        let after = winding - group.iter().map(|c| c.1).sum::<i32>();
        if (winding == 0) != (after == 0) {
            flips.push(group[0].0);
        }
        winding = after;
    }
}
