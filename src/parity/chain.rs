//! All twins in the order of [`frame`](crate::frame): the inputs and the outputs of every pass.

use super::Case;
use crate::abi::{Counters, StripRows, SubPatch};
use crate::twin;
use crate::twin::density::Density;
use crate::twin::emit::Draw;
use crate::twin::split::Split;

/// The contents of a buffer that no pass has written.
pub(super) const UNTOUCHED: u32 = 0xA5A5_A5A5;
/// [`UNTOUCHED`] as an entry of the draw list.
pub(super) const UNTOUCHED_SUB_PATCH: SubPatch = SubPatch { patch_instance: UNTOUCHED, place: UNTOUCHED };

/// Every buffer of a frame.
#[derive(Clone, Debug, Default)]
pub(super) struct Chain {
    pub taus: Vec<u32>,
    pub split: Split,
    pub sub_patch_starts: Vec<u32>,
    pub vertex_starts: Vec<u32>,
    pub sub_patches: Vec<SubPatch>,
    pub draws: Vec<Draw>,
    pub density: Density,
    pub strip_counts: Vec<u32>,
    pub strip_starts: Vec<u32>,
    pub segment_counts: Vec<u32>,
    pub segment_starts: Vec<u32>,
    pub dispatches: [[u32; 3]; 3],
    pub strips: Vec<StripRows>,
    pub row_counts: Vec<u32>,
    /// After `cross`, and after `carry`.
    pub rows_add_up: Vec<i32>,
    pub row_windings: Vec<i32>,
    pub border_cells: Vec<[u32; 4]>,
    pub row_starts: Vec<u32>,
    pub row_total: u32,
    /// After `cross`; the order within a row is unspecified.
    pub intercepts: Vec<u32>,
    /// After `sort`: the first `flip_counts[row] >> 1` words of a row are float bits.
    pub flips: Vec<u32>,
    pub flip_counts: Vec<u32>,
    pub counters: Counters,
}

impl Chain {
    pub(super) fn new(case: &Case) -> Self {
        Self::with_table_of(case, case)
    }

    /// With a trim table made for another view of the same scene.
    pub(super) fn with_table_of(case: &Case, table: &Case) -> Self {
        let (frame, scene) = (&case.frame, &case.scene());
        let mut c = Self::default();
        (c.draws, c.counters) = twin::reset::reset(frame);
        c.taus = twin::bound::bound(frame, scene, &mut c.counters);
        c.split = twin::split::split(frame, scene, &c.taus);
        c.sub_patch_starts = starts(&c.split.sub_patch_counts);
        c.vertex_starts = starts(&c.split.vertex_counts);
        c.sub_patches = vec![UNTOUCHED_SUB_PATCH; frame.sub_patch_capacity as usize];
        let list = (c.sub_patches.as_mut_slice(), c.draws.as_mut_slice());
        twin::emit::emit(frame, &c.split.factors, &c.sub_patch_starts, &c.vertex_starts, list, &mut c.counters);

        c.density = twin::density::density(&table.frame, &table.scene());
        c.strip_counts = twin::lines::lines(frame, &c.density.strip_heights, &c.density.seen_bins, &mut c.counters);
        c.strip_starts = starts(&c.strip_counts);
        c.segment_counts = twin::segments::segments(frame, scene, &c.density, &c.strip_starts);
        c.segment_starts = starts(&c.segment_counts);
        c.dispatches =
            twin::dispatch_arguments::dispatch_arguments(frame, &c.strip_starts, &c.segment_starts, &mut c.counters);
        c.strips = twin::dispatch_arguments::strips(&c.strip_starts, &c.density.seen_bins);
        (c.row_counts, c.rows_add_up) = twin::cross::count(frame, scene, &c.strips, &c.segment_starts);
        c.border_cells = twin::cross::border_cells(frame, scene, &c.strips, &c.segment_starts);
        c.row_windings = c.rows_add_up.clone();
        twin::carry::carry(frame, &c.strips, &case.data.wide_strips, &mut c.row_windings);
        (c.row_starts, c.row_total) = twin::scan::scan(&c.row_counts[..c.counters.rows as usize]);
        c.intercepts = vec![UNTOUCHED; frame.intercept_capacity as usize];
        let (mut counts, given) = (c.row_counts.clone(), (c.strips.as_slice(), c.segment_starts.as_slice()));
        twin::cross::insert(frame, scene, given, &c.row_starts, &mut counts, &mut c.intercepts);
        c.flips = c.intercepts.clone();
        let windings = &c.row_windings;
        c.flip_counts = twin::sort::sort(frame, &c.row_starts, c.row_total, windings, &mut c.flips, &mut c.counters);
        c
    }

    /// Of pass `split` alone, from given segments, and the prefix sums that pass `emit` reads.
    #[cfg(feature = "headless")]
    pub(super) fn of_taus(case: &Case, taus: &[u32]) -> Self {
        let split = twin::split::split(&case.frame, &case.scene(), taus);
        let (sub_patch_starts, vertex_starts) = (starts(&split.sub_patch_counts), starts(&split.vertex_counts));
        Self { taus: taus.to_vec(), split, sub_patch_starts, vertex_starts, ..Self::default() }
    }
}

/// Prefix sums, followed by the total.
fn starts(counts: &[u32]) -> Vec<u32> {
    let (mut starts, total) = twin::scan::scan(counts);
    starts.push(total);
    starts
}
