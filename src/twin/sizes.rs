//! Twin of the pass `sizes`: where the rows of each v-strip are; rows and segments of the whole trim
//! table, and the dispatches that follow from them.

use super::FAILED_ROWS;
use super::u_bins::seen_range;
use crate::abi::constants::sizes::{GROUP, MAX_GROUPS, SCAN_BLOCK};
use crate::abi::{Counters, Frame, StripRows};

/// Most segments that pass `cross` can be given.
pub const MOST_SEGMENTS: u32 = MAX_GROUPS * GROUP;

/// Where the rows of each strip are, at its first bin.
pub fn strips(strip_starts: &[u32], seen_bins: &[u32]) -> Vec<StripRows> {
    let of_strip = |(pair, &seen): (&[u32], &u32)| {
        let (first_bin, bins) = seen_range(seen);
        StripRows { first: pair[0], lines: (pair[1] - pair[0]) / bins, first_bin, bins }
    };
    strip_starts.windows(2).zip(seen_bins).map(of_strip).collect()
}

/// Workgroups of `cross`, of `sort` and of the scan of the rows. Sets `rows`,
/// `wanted_rows` and `segments` of the counters.
pub fn sizes(frame: &Frame, strip_starts: &[u32], segment_starts: &[u32], counters: &mut Counters) -> [[u32; 3]; 3] {
    let wanted = strip_starts[frame.bin_count as usize];
    let segments = segment_starts[frame.curve_count as usize];
    if wanted > frame.row_capacity {
        counters.failed |= FAILED_ROWS;
    }
    counters.clamps += u32::from(segments > MOST_SEGMENTS);
    counters.rows = wanted.min(frame.row_capacity);
    counters.wanted_rows = wanted;
    counters.segments = segments.min(MOST_SEGMENTS);
    let groups = |threads: u32, group: u32| [threads.div_ceil(group), 1, 1];
    [groups(counters.segments, GROUP), groups(counters.rows, GROUP), groups(counters.rows, SCAN_BLOCK)]
}
