//! The number of a face's cells of the first level, and the cells near each arc.

use super::{Arc, Grid, MARGIN};
use glam::{DVec2, IVec2};
use std::ops::RangeInclusive;

/// Arcs to a cell of the first level, on average.
const ARCS_A_CELL: f64 = 1.0;
/// Cells to an arc at most, and cells that hold an arc, summed over all arcs.
const MOST_CELLS_AN_ARC: f64 = 8.0;
/// Finest columns and rows, of the domain.
const MOST_BITS: u32 = 15;
/// Most columns or rows.
const MOST_COUNT: f64 = 4096.0;

impl Grid {
    /// The grid around all arcs. Cells have the average proportions of arcs, so they are about square on the surface.
    pub(super) fn around(arcs: &[Arc]) -> Self {
        if arcs.is_empty() {
            return Self { first: [0; 2], counts: [1; 2], bits: [0; 2] };
        }
        let point = |p: [f32; 2]| DVec2::from(p.map(f64::from));
        let (lo, hi) = arcs.iter().fold((DVec2::MAX, DVec2::MIN), |(lo, hi), arc| {
            let (a, b) = (point(arc.low), point(arc.high));
            (lo.min(a.min(b)), hi.max(a.max(b)))
        });
        let lengths: DVec2 = arcs.iter().map(|arc| (point(arc.high) - point(arc.low)).abs()).sum();
        let ratio = (lengths.x / lengths.y).clamp(1e-4, 1e4);
        let cells = (arcs.len() as f64 / ARCS_A_CELL).max(1.0);
        let height = ((hi - lo).max(DVec2::splat(1e-7)).element_product() / (cells * ratio)).sqrt();
        let sides = DVec2::new(ratio * height, height);
        let mut bits = sides.to_array().map(|side| (-side.log2()).round().clamp(0.0, f64::from(MOST_BITS)) as u32);
        let most = MOST_CELLS_AN_ARC * arcs.len() as f64;
        loop {
            let scale = DVec2::from(bits.map(|b| f64::from(1u32 << b)));
            let (first, end) = ((lo * scale).floor(), (hi * scale).ceil());
            let counts = (end - first).max(DVec2::ONE);
            let met: f64 = arcs.iter().map(|arc| cells_met((point(arc.high) - point(arc.low)).abs() * scale)).sum();
            let fits = counts.max_element() <= MOST_COUNT && counts.element_product() <= most && met <= most;
            if fits || bits == [0; 2] {
                // points beyond belong to the outermost cells: one cell serves loops that are many domains wide
                let first = first.to_array().map(|x| x as i16);
                let counts = if fits { counts.to_array().map(|n| n as u16) } else { [1; 2] };
                return Self { first, counts, bits };
            }
            bits = bits.map(|b| b.saturating_sub(1));
        }
    }

    /// Width and height of a cell.
    pub(super) fn sides(&self) -> DVec2 {
        DVec2::from(self.bits.map(|b| 1.0 / f64::from(1u32 << b)))
    }

    /// The columns (`axis` 0) or rows whose boxes, margin included, meet a range.
    pub(super) fn meeting(&self, axis: usize, (lo, hi): (f64, f64)) -> RangeInclusive<u32> {
        let scale = f64::from(1u32 << self.bits[axis]);
        let (first, last) = (f64::from(self.first[axis]), f64::from(self.counts[axis] - 1));
        let margin = f64::from(MARGIN);
        let from = (lo * scale - first - 1.0 - margin).ceil().clamp(0.0, last);
        let to = (hi * scale - first + margin).floor().clamp(0.0, last);
        from as u32..=to as u32
    }
}

/// Cells met by an arc of this width and height.
fn cells_met(size: DVec2) -> f64 {
    size.x + size.y + 1.0 + 2.0 * f64::from(MARGIN)
}

/// A part of the domain with one list.
#[derive(Clone, Copy, Debug)]
pub(super) struct Region {
    /// Its own rectangle.
    pub lo: DVec2,
    pub hi: DVec2,
    /// The box of its list: wider, and infinite beyond the outermost cells.
    pub box_lo: DVec2,
    pub box_hi: DVec2,
}

impl Region {
    /// One of a grid's cells.
    pub(super) fn of(grid: &Grid, at: [u32; 2]) -> Self {
        let sides = grid.sides();
        let first = DVec2::from(grid.first.map(f64::from));
        let at = IVec2::from(at.map(|i| i as i32));
        let lo = (first + at.as_dvec2()) * sides;
        let last = IVec2::from(grid.counts.map(|n| i32::from(n) - 1));
        Self::new(lo, sides, at.cmpeq(IVec2::ZERO).into(), at.cmpeq(last).into())
    }

    /// One of the cells that this one is split into.
    pub(super) fn part(&self, at: [u32; 2], halvings: u32) -> Self {
        let n = 1 << halvings;
        let sides = (self.hi - self.lo) / f64::from(n);
        let lo = self.lo + DVec2::from(at.map(f64::from)) * sides;
        let outer = |edge: DVec2, i: usize| edge[i].is_infinite();
        let first = std::array::from_fn(|i| at[i] == 0 && outer(self.box_lo, i));
        let last = std::array::from_fn(|i| at[i] == n - 1 && outer(self.box_hi, i));
        Self::new(lo, sides, first, last)
    }

    fn new(lo: DVec2, sides: DVec2, first: [bool; 2], last: [bool; 2]) -> Self {
        let (hi, margin) = (lo + sides, f64::from(MARGIN) * sides);
        let box_lo = DVec2::select(first.into(), DVec2::NEG_INFINITY, lo - margin);
        let box_hi = DVec2::select(last.into(), DVec2::INFINITY, hi + margin);
        Self { lo, hi, box_lo, box_hi }
    }

    /// The point at which the winding number of the rest of the loops is computed.
    pub(super) fn centre(&self) -> DVec2 {
        0.5 * (self.lo + self.hi)
    }

    /// Whether an arc meets the box.
    pub(super) fn meets(&self, arc: &Arc) -> bool {
        let rows = (self.box_lo.y, self.box_hi.y);
        arc.span(rows).is_some_and(|(left, right)| left <= self.box_hi.x && right >= self.box_lo.x)
    }
}

impl Arc {
    /// Least and largest `u` between two scan lines, rounded outwards; `None` where no part of it is.
    pub(super) fn span(&self, (lo, hi): (f64, f64)) -> Option<(f64, f64)> {
        let [from, to] = [self.low, self.high].map(|p| p.map(f64::from));
        if from[1] > hi || to[1] < lo {
            return None;
        }
        let bottom = if from[1] < lo { self.at(lo) } else { from[0] };
        let top = if to[1] > hi { self.at(hi) } else { to[0] };
        let rounding = 1e-6 * (to[0] - from[0]).abs();
        Some((bottom.min(top) - rounding, bottom.max(top) + rounding))
    }

    /// `u` where it passes a scan line between its ends.
    ///
    /// With `r = t / (1 - t)` and the corner's weight `w` the coordinate is `(2 w r c + r² d) / (1 + 2 w r + r²)`, so `r` is
    /// the positive root of `(d - v) r² + 2 w (c - v) r - v`, of which there is one.
    pub(super) fn at(&self, v: f64) -> f64 {
        let base = DVec2::from(self.low.map(f64::from));
        let chord = DVec2::from(self.high.map(f64::from)) - base;
        let (corner, y) = (DVec2::from(self.corner.map(f64::from)), v - base.y);
        if self.fullness == 0.0 {
            return base.x + chord.x * (y / chord.y);
        }
        let w = 0.5 * f64::from(self.fullness).sqrt();
        let (a, b) = (chord.y - y, w * (corner.y - y));
        let root = (b * b + a * y).sqrt();
        let r = if b > 0.0 { y / (b + root) } else { (root - b) / a };
        base.x + (2.0 * w * r * corner.x + r * r * chord.x) / (1.0 + 2.0 * w * r + r * r)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Straight sides of a rectangle.
    fn rectangle(width: f32, height: f32) -> Vec<Arc> {
        let side = |low, high, up| Arc { low, high, corner: [0.0; 2], fullness: 0.0, up };
        let corners = [[0.0, 0.0], [width, 0.0], [width, height], [0.0, height]];
        vec![
            side(corners[0], corners[1], true),
            side(corners[1], corners[2], true),
            side(corners[3], corners[2], false),
            side(corners[0], corners[3], false),
        ]
    }

    /// About as many cells as arcs, however wide, narrow or far away the loops are.
    #[test]
    fn cells_are_few_whatever_the_size() {
        let sizes = [1e-30, 1e-7, 1e-3, 1.0, 5e3, 1e6, 1e30, f32::MAX];
        for (width, height) in sizes.into_iter().flat_map(|w| sizes.map(|h| (w, h))) {
            let arcs = rectangle(width, height);
            let grid = Grid::around(&arcs);
            let cells = f64::from(grid.counts[0]) * f64::from(grid.counts[1]);
            assert!(cells <= MOST_CELLS_AN_ARC * arcs.len() as f64, "{width:e} x {height:e}: {grid:?}");
        }
        assert_eq!(Grid::around(&rectangle(1.0, 1.0)), Grid { first: [0; 2], counts: [2; 2], bits: [1; 2] });
    }
}
