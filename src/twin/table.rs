//! Twin of `glsl/include/table.glsl`: look-up in the u-intercept table, nearest scan line, then a binary
//! search.

use super::border_cells::columns_between;
use crate::abi::BORDER_BANDS;

/// The table as the passes leave it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Table<'a> {
    /// First row of each placed strip, and how many it has.
    pub strips: &'a [[u32; 2]],
    /// First flip of each row.
    pub row_starts: &'a [u32],
    /// Flips of each row.
    pub row_counts: &'a [u32],
    /// Their `u`, ascending in each row.
    pub flips: &'a [f32],
    /// Columns of each band that trim curves pass.
    pub border_cells: &'a [[u32; 4]],
    /// Rows that there is room for.
    pub row_capacity: u32,
}

impl Table<'_> {
    /// Whether the normalised `(u, v)` belongs to the placed face whose `strips` v-strips begin at
    /// `first_strip`. A point beyond the capacity does: the host grows the table and records again.
    pub fn inside(&self, first_strip: u32, strips: f32, [u, v]: [f32; 2]) -> bool {
        let s = v * strips;
        if !(s >= 0.0 && s < strips) {
            return false;
        }
        let [base, count] = self.strips[first_strip as usize + s as usize];
        if count == 0 {
            return false;
        }
        let row = base + (((s - s.floor()) * count as f32) as u32).min(count - 1);
        if row >= self.row_capacity {
            return true;
        }
        let (first, flips) = (self.row_starts[row as usize] as usize, self.row_counts[row as usize] as usize);
        if flips == 0 {
            return false; // also a row that found no room
        }
        self.flips[first..first + flips].partition_point(|&flip| flip <= u) % 2 == 1
    }

    /// Whether all of the box from `lo` to `hi` is inside or none of it. `false` where that is not easily told.
    pub fn same(&self, first_strip: u32, strips: f32, lo: [f32; 2], hi: [f32; 2]) -> bool {
        let (from, to) = (lo[1] * strips, hi[1] * strips);
        if !(from >= 0.0 && to < strips) {
            return false;
        }
        let bands = BORDER_BANDS as f32;
        let (first, last) = ((from * bands) as u32, (to * bands) as u32);
        if last > first + 1 || first / BORDER_BANDS != last / BORDER_BANDS {
            return false;
        }
        let band = |k: u32| self.border_cells[(first_strip * BORDER_BANDS + k) as usize];
        let columns = columns_between(lo[0], hi[0]);
        (0..4).all(|w| (band(first)[w] | band(last)[w]) & columns[w] == 0)
    }
}
