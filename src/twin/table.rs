//! Twin of `glsl/include/table.glsl`: look-up in the u-intercept table, nearest scan line, then a binary
//! search.

/// The table as the passes leave it.
#[derive(Clone, Copy, Debug, Default)]
pub struct Table<'a> {
    /// Rows before each placed strip, and the total.
    pub line_starts: &'a [u32],
    /// First flip of each row.
    pub row_starts: &'a [u32],
    /// Flips of each row.
    pub row_counts: &'a [u32],
    /// Their `u`, ascending in each row.
    pub flips: &'a [f32],
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
        let strip = first_strip as usize + s as usize;
        let base = self.line_starts[strip];
        let count = self.line_starts[strip + 1] - base;
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
}
