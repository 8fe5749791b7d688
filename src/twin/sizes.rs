//! Twin of the pass [`sizes`](crate::passes): where the rows of each v-strip are; rows and segments of the whole trim
//! table, and the dispatches that follow from them.

use super::FAILED_ROWS;
use crate::abi::{Counters, Frame};

/// Threads of a workgroup in passes `cross` and `sort`.
const GROUP: u32 = 128;
/// Rows of a workgroup in the prefix sum.
const SCAN_BLOCK: u32 = 1024;
/// Workgroups that every device can dispatch.
const MAX_GROUPS: u32 = 65535;
/// Most segments that pass `cross` can be given.
pub const MOST_SEGMENTS: u32 = MAX_GROUPS * GROUP;

/// First row of each strip, and how many it has.
pub fn strips(line_starts: &[u32]) -> Vec<[u32; 2]> {
    line_starts.windows(2).map(|pair| [pair[0], pair[1] - pair[0]]).collect()
}

/// Workgroups of `cross`, of `sort` and of the scan of the rows. Sets `rows`,
/// `wanted_rows` and `segments` of the counters.
pub fn sizes(frame: &Frame, line_starts: &[u32], segment_starts: &[u32], counters: &mut Counters) -> [[u32; 3]; 3] {
    let wanted = line_starts[frame.strip_count as usize];
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
