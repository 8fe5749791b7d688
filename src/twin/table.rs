//! Twin of `glsl/include/table.glsl`: look-up in the u-intercept table, nearest scan line, then a binary
//! search.

use super::border_cells::columns_between;
use super::u_bins::{bin_of, within_bin};
pub use crate::abi::constants::along::{ALONG_BEFORE, ALONG_BEHIND, ALONG_INSIDE};
use crate::abi::{BORDER_BANDS, Face, StripRows};

/// The table after the passes.
#[derive(Clone, Copy, Debug, Default)]
pub struct Table<'a> {
    /// The rows of each placed strip, at its first bin.
    pub strips: &'a [StripRows],
    /// First flip of each row.
    pub row_starts: &'a [u32],
    /// Number of flips of each row, times two, plus 1 if it starts inside.
    pub row_counts: &'a [u32],
    /// Their `u`, ascending in each row.
    pub flips: &'a [f32],
    /// Columns of each band of each bin that trim curves cross.
    pub border_cells: &'a [[u32; 4]],
    /// Capacity in rows.
    pub row_capacity: u32,
}

impl Table<'_> {
    /// Whether the normalised `(u, v)` is inside the placed `face`, whose bin instances begin at `first_bin`. True for
    /// a row beyond the capacity: the host enlarges the table and records again.
    pub fn inside(&self, first_bin: u32, face: &Face, uv: [f32; 2]) -> bool {
        self.along(first_bin, face, uv, 0.0) & ALONG_INSIDE != 0
    }

    /// The same, and whether flips of the point's scan line are within `reach` of `u`, in its bin.
    pub fn along(&self, first_bin: u32, face: &Face, [u, v]: [f32; 2], reach: f32) -> u32 {
        let (strips, bins) = (face.strip_count() as f32, face.bin_count());
        let s = v * strips;
        if !(s >= 0.0 && s < strips) {
            return 0;
        }
        let rows = self.strips[(first_bin + s as u32 * bins) as usize];
        if rows.lines == 0 {
            return 0;
        }
        let line = (((s - s.floor()) * rows.lines as f32) as u32).min(rows.lines - 1);
        let row = rows.row_of(line, bin_of(u, bins));
        if row >= self.row_capacity {
            return ALONG_INSIDE;
        }
        let (first, counted) = (self.row_starts[row as usize] as usize, self.row_counts[row as usize]);
        let flips = (counted >> 1) as usize;
        if flips == 0 {
            return counted & ALONG_INSIDE; // 0 also for a row beyond the capacity
        }
        let flips = &self.flips[first..first + flips];
        let (before, behind) = flips.split_at(flips.partition_point(|&flip| flip <= u));
        let is_near = |near: bool, bit: u32| if near { bit } else { 0 };
        (before.len() as u32 ^ counted) & ALONG_INSIDE
            | is_near(before.last().is_some_and(|&flip| flip > u - reach), ALONG_BEFORE)
            | is_near(behind.first().is_some_and(|&flip| flip < u + reach), ALONG_BEHIND)
    }

    /// Whether the box from `lo` to `hi` is inside or outside as a whole. `false` if this is undecided.
    pub fn same(&self, first_bin: u32, face: &Face, lo: [f32; 2], hi: [f32; 2]) -> bool {
        let (strips, bins) = (face.strip_count() as f32, face.bin_count());
        let (from, to) = (lo[1] * strips, hi[1] * strips);
        if !(from >= 0.0 && to < strips) {
            return false;
        }
        let (strip, bin) = (from as u32, bin_of(lo[0], bins));
        if to as u32 != strip || bin_of(hi[0], bins) != bin {
            return false;
        }
        let (first, last) = ((from * BORDER_BANDS as f32) as u32, (to * BORDER_BANDS as f32) as u32);
        if last > first + 1 {
            return false;
        }
        let bin_instance = first_bin + strip * bins + bin;
        let band = |k: u32| self.border_cells[(bin_instance * BORDER_BANDS + k - strip * BORDER_BANDS) as usize];
        let columns = columns_between(within_bin(lo[0], bin, bins), within_bin(hi[0], bin, bins));
        (0..4).all(|w| (band(first)[w] | band(last)[w]) & columns[w] == 0)
    }
}
