//! Twin of `glsl/include/border_cells.glsl`: a coarse map of trim curves.

use crate::abi::BORDER_COLUMNS;

/// The bits of the columns from `lo` to `hi` in `u`; `u` beyond the face counts as its outermost column.
pub fn columns_between(lo: f32, hi: f32) -> [u32; 4] {
    let column = |u: f32| (u * BORDER_COLUMNS as f32).floor().clamp(0.0, BORDER_COLUMNS as f32 - 1.0) as u32;
    let mut words = [0; 4];
    for c in column(lo)..=column(hi) {
        words[(c / 32) as usize] |= 1 << (c % 32);
    }
    words
}
