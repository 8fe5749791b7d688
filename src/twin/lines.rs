//! Twin of the pass `lines`: `mu = ceil(height / spacing)` scan lines for each v-strip, and a row of each in every bin
//! from the first to the last visible one.

use super::u_bins::seen_range;
pub use crate::abi::constants::scene::MAX_ROWS;
use crate::abi::{Counters, Frame};

/// Rows of each strip of `strip_heights` pixels, at its first bin; strips with more than [`MAX_ROWS`] scan lines are
/// clamps.
pub fn lines(frame: &Frame, strip_heights: &[f32], seen_bins: &[u32], counters: &mut Counters) -> Vec<u32> {
    strip_heights
        .iter()
        .zip(seen_bins)
        .map(|(height, &seen)| {
            let lines = (height / frame.row_px).ceil();
            counters.clamps += u32::from(lines > MAX_ROWS as f32);
            lines.min(MAX_ROWS as f32) as u32 * seen_range(seen).1
        })
        .collect()
}
