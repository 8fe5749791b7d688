//! A grid over the loops that answers most points, and boxes around them, by a look.
//!
//! ```text
//!   ┌───┬───┬───┬───┐      coarse cells: out, in, or a loop passes: then a tile of TILE x TILE fine
//!   │ o │▒▒▒│▒▒▒│ o │      cells, each out, in or *near* a loop
//!   ├───┼───┼───┼───┤
//!   │▒▒▒│ i │ i │▒▒▒│      a fine cell is near a loop when it meets the box of a part of an arc,
//!   ├───┼───┼───┼───┤      widened by more than the exact test is off; cells side by side that are
//!   │ o │▒▒▒│▒▒▒│ o │      not lie on the same side of every loop
//!   └───┴───┴───┴───┘
//! ```
//!
//! The cell of a coordinate is found by one subtraction and one product, rounded: both never fall as the
//! coordinate grows, so whatever lies between two coordinates lies in a cell between theirs, and arcs are
//! sorted in by the same two roundings as points. What lies beyond the grid is in its outermost cells.

use super::bands::crossing;
use super::{AT_HIGH, AT_LOW, Arc, ExactTrim};
use crate::spline::Bezier;
use glam::{DVec2, DVec3};

/// Fine cells along the side of a coarse one; a line of them makes a word.
const TILE: u32 = 16;
/// A fine cell: two bits.
const OUT: u8 = 0;
const IN: u8 = 1;
const NEAR: u8 = 2;
/// Coarse cells along a side: with this many, a face of four straight sides takes some 5 KiB.
const LEAST_ACROSS: u32 = 16;
/// With this many and all of them near a loop, 4 MiB.
const MOST_ACROSS: u32 = 256;
/// Coarse cells an arc: a hole of four arcs then spans about three of them each way.
const CELLS_AN_ARC: usize = 2;
/// Cells that stay beyond the loops on each side.
const MARGIN: f64 = 2.0;
/// How far an arc reaches beyond its own points, in roundings of the largest coordinate, at least 1: four
/// for the test's answers, two for each of the two coordinates that are compared.
const REACH: f64 = 8.0;
/// Halvings of an arc; its parts are then narrower than any cell.
const HALVINGS: u32 = 24;

/// See the module.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Grid {
    /// Where its first cell begins.
    pub origin: [f32; 2],
    /// Fine cells a unit.
    pub scale: [f32; 2],
    /// Coarse cells along each side; none without loops.
    pub across: u32,
    /// Coarse cells, row by row: 0 out, 1 in, else where their tile begins in this list. Then the tiles: a
    /// word for each row of fine cells, two bits a cell, the first one lowest; 0 out, 1 in, 2 near a loop.
    pub words: Vec<u32>,
}

impl Grid {
    pub(super) fn new(trim: &ExactTrim) -> Self {
        if trim.arcs.is_empty() {
            return Self::default();
        }
        let (lo, hi) = trim
            .arcs
            .iter()
            .flat_map(|a| [a.low, a.high])
            .map(point)
            .fold((DVec2::INFINITY, DVec2::NEG_INFINITY), |(lo, hi), p| (lo.min(p), hi.max(p)));
        let across = ((CELLS_AN_ARC * trim.arcs.len()) as f64).sqrt() as u32;
        let across = across.clamp(LEAST_ACROSS, MOST_ACROSS);
        let fine = f64::from(across * TILE);
        let reach = REACH * f64::from(f32::EPSILON) * lo.abs().max(hi.abs()).max_element().max(1.0);
        let scale = (fine - 2.0 * MARGIN) / (hi - lo).max(DVec2::splat(reach));
        let mut grid = Self {
            origin: (lo - MARGIN / scale).as_vec2().to_array(),
            scale: scale.as_vec2().to_array(),
            across,
            words: Vec::new(),
        };
        let mut cells = vec![OUT; (across * TILE * across * TILE) as usize];
        trim.arcs.iter().for_each(|arc| grid.sort_in(arc, reach, &mut cells));
        grid.fill(trim, &mut cells);
        grid.pack(&cells);
        grid
    }

    /// Fine cell of a coordinate, as the shader finds it.
    fn cell(&self, axis: usize, x: f32) -> u32 {
        let last = (self.across * TILE - 1) as f32;
        ((x - self.origin[axis]) * self.scale[axis]).max(0.0).min(last) as u32
    }

    fn index(&self, column: u32, row: u32) -> usize {
        (row * self.across * TILE + column) as usize
    }

    /// Marks the cells that an arc comes near.
    fn sort_in(&self, arc: &Arc, reach: f64, cells: &mut [u8]) {
        let low = point(arc.low);
        let chord = point(arc.high) - low;
        let curve = Bezier { points: arc.points.iter().map(|p| DVec3::from(p.map(f64::from))).collect() };
        let mut parts = vec![((0.0, DVec2::ZERO), (1.0, chord), HALVINGS)];
        while let Some((a, b, halvings)) = parts.pop() {
            let corner = |p: DVec2| [self.cell(0, p.x as f32), self.cell(1, p.y as f32)];
            let from = corner(low + a.1.min(b.1) - reach);
            let to = corner(low + a.1.max(b.1) + reach);
            let (wide, high) = (to[0] - from[0], to[1] - from[1]);
            if wide == 0 || high == 0 || wide.max(high) == 1 || halvings == 0 {
                for row in from[1]..=to[1] {
                    cells[self.index(from[0], row)..=self.index(to[0], row)].fill(NEAR);
                }
                continue;
            }
            let t = 0.5 * (a.0 + b.0);
            let middle = if curve.points.is_empty() { t * chord } else { curve.point(t) };
            let middle = (t, middle.clamp(a.1.min(b.1), a.1.max(b.1)));
            parts.extend([(a, middle, halvings - 1), (middle, b, halvings - 1)]);
        }
    }

    /// Gives each cell that no arc comes near its side: that of a neighbour, where one has it.
    fn fill(&self, trim: &ExactTrim, cells: &mut [u8]) {
        let fine = self.across * TILE;
        for row in 0..fine {
            for column in 0..fine {
                let i = self.index(column, row);
                let clear = |j: usize| Some(cells[j]).filter(|&cell| cell != NEAR);
                if cells[i] == NEAR {
                    continue;
                }
                let left = (column > 0).then(|| i - 1).and_then(clear);
                let below = (row > 0).then(|| i - fine as usize).and_then(clear);
                cells[i] = left.or(below).unwrap_or_else(|| self.side(trim, column, row));
            }
        }
    }

    /// Asks the loops themselves. What cannot be told stays near a loop.
    fn side(&self, trim: &ExactTrim, column: u32, row: u32) -> u8 {
        let centre = |axis: usize, cell: u32| {
            (f64::from(self.origin[axis]) + (f64::from(cell) + 0.5) / f64::from(self.scale[axis])) as f32
        };
        let p = [centre(0, column), centre(1, row)];
        if [self.cell(0, p[0]), self.cell(1, p[1])] != [column, row] {
            return NEAR;
        }
        trim.clear_winding(p).map_or(NEAR, |winding| if winding == 0 { OUT } else { IN })
    }

    fn pack(&mut self, cells: &[u8]) {
        let mut tiles = Vec::new();
        for place in 0..self.across * self.across {
            let (column, row) = (place % self.across * TILE, place / self.across * TILE);
            let lines = (row..row + TILE).map(|row| &cells[self.index(column, row)..][..TILE as usize]);
            let tile: Vec<u32> =
                lines.map(|line| line.iter().rev().fold(0, |word, &cell| word << 2 | u32::from(cell))).collect();
            let all = |side: u32| tile.iter().all(|&word| word == side * 0x5555_5555);
            self.words.push(match (all(0), all(1)) {
                (true, _) => 0,
                (_, true) => 1,
                _ => {
                    let first = self.across * self.across + tiles.len() as u32;
                    tiles.extend(tile);
                    first
                }
            });
        }
        self.words.append(&mut tiles);
    }
}

impl ExactTrim {
    /// Winding number around a point that is not next to a loop; `None` next to one.
    fn clear_winding(&self, [u, v]: [f32; 2]) -> Option<i32> {
        let band = self.bands.partition_point(|band| band.top < v);
        if band == 0 || band == self.bands.len() {
            return Some(0);
        }
        let cells = &self.cells[self.bands[band - 1].end as usize..self.bands[band].end as usize];
        let Some(cell) = cells.get(cells.partition_point(|cell| cell.right < u)) else { return Some(0) };
        let mut winding = cell.winding;
        for entry in &self.entries[cell.first as usize..][..cell.count as usize] {
            let arc = &self.arcs[(entry >> 2) as usize];
            let sign = if arc.up { 1 } else { -1 };
            winding -= if entry & AT_LOW != 0 && arc.low[1] < v { sign } else { 0 };
            winding += if entry & AT_HIGH != 0 && arc.high[1] < v { sign } else { 0 };
            if arc.low[1] < v && v <= arc.high[1] {
                let (left, right) = if v < arc.high[1] { crossing(arc, v) } else { (arc.high[0], arc.high[0]) };
                match (u < left, u >= right) {
                    (true, _) => winding += sign,
                    (_, true) => {}
                    _ => return None,
                }
            }
        }
        Some(winding)
    }
}

fn point(p: [f32; 2]) -> DVec2 {
    DVec2::from(p.map(f64::from))
}
