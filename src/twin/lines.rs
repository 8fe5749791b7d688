//! Twin of the pass [`lines`](crate::passes): `mu = ceil(height / spacing)` scan lines for each v-strip.

use crate::abi::{Counters, Frame};

/// Most scan lines of one strip.
pub const MAX_ROWS: u32 = 65536;

/// Scan lines of each strip of `strip_heights` pixels; those cut to [`MAX_ROWS`] count as clamps.
pub fn lines(frame: &Frame, strip_heights: &[f32], counters: &mut Counters) -> Vec<u32> {
    strip_heights
        .iter()
        .map(|height| {
            let lines = (height / frame.row_px).ceil();
            counters.clamps += u32::from(lines > MAX_ROWS as f32);
            lines.min(MAX_ROWS as f32) as u32
        })
        .collect()
}
