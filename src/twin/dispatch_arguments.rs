//! Twin of the pass `dispatch_arguments`: the first row of each v-strip, the numbers of rows and segments in the trim table, and the
//! dispatches that follow from them.

use super::FAILED_ROWS;
use super::grid::grid_of;
use super::u_bins::seen_range;
pub use crate::abi::constants::dispatch_arguments::MOST_NUMBERED as MOST_SEGMENTS;
use crate::abi::constants::dispatch_arguments::{GROUP, SCAN_BLOCK};
use crate::abi::{Counters, Frame, StripRows};

/// The rows of each strip, stored at its first bin.
pub fn strips(strip_starts: &[u32], seen_bins: &[u32]) -> Vec<StripRows> {
    let of_strip = |(pair, &seen): (&[u32], &u32)| {
        let (first_bin, bins) = seen_range(seen);
        StripRows { first: pair[0], lines: pair[1].wrapping_sub(pair[0]) / bins, first_bin, bins }
    };
    strip_starts.windows(2).zip(seen_bins).map(of_strip).collect()
}

/// Workgroups of `cross`, of `sort` and of the scan of the rows. Sets `rows`,
/// `wanted_rows` and `segments` of the counters.
pub fn dispatch_arguments(
    frame: &Frame,
    strip_starts: &[u32],
    segment_starts: &[u32],
    counters: &mut Counters,
) -> [[u32; 3]; 3] {
    let wanted = strip_starts[frame.bin_count as usize];
    let segments = segment_starts[frame.curve_count as usize];
    let starts = &strip_starts[..=frame.bin_count as usize];
    let wrapped = starts.windows(2).any(|pair| pair[1] < pair[0]);
    if wanted > frame.row_capacity || wrapped {
        counters.failed |= FAILED_ROWS;
    }
    counters.clamps += u32::from(segments > MOST_SEGMENTS);
    counters.rows = wanted.min(frame.row_capacity);
    // the sum of the rows exceeds 32 bits
    counters.wanted_rows = if wrapped { u32::MAX } else { wanted };
    counters.segments = segments.min(MOST_SEGMENTS);
    let groups = |threads: u32, group: u32| grid_of(frame, threads.div_ceil(group));
    [groups(counters.segments, GROUP), groups(counters.rows, GROUP), groups(counters.rows, SCAN_BLOCK)]
}
