//! The frame's part for the trim table: the u-intercepts of this view, and of others from as far or from near by.
//!
//! ```text
//!   cells ──density──▶ strip heights ──lines──(scan)──▶ rows
//!   curves ──segments──(scan)──▶ chords ──sizes──▶ dispatches
//!   chords ──cross: count──(scan)──▶ cross: insert──▶ intercepts ──sort──▶ flips of each row
//!                 ╰──▶ row windings ──carry──▶ what rows begin with ──╯       only where strips have several bays
//! ```
//!
//! A table is made once and stays until there is a view that it does not serve (`scene::trimmed`), or an edit; `kept.rs` tells
//! how.

use crate::abi::Counters;
use crate::frame::buffers::TableBuffers;
use crate::frame::common::scan;
use crate::frame::trim::carry;
use crate::frame::trim::cross;
use crate::frame::trim::density;
use crate::frame::trim::lines;
use crate::frame::trim::segments;
use crate::frame::trim::sizes;
use crate::frame::trim::sort;
use crate::frame::{Frame, WRITE_TO_READ};
use crate::gpu::{Access, Commands, Device, GpuError, Resource, barrier};
use crate::scene::TableScene;
use std::mem::offset_of;

/// The passes of the trim table.
pub(crate) struct TablePasses {
    density: density::Density,
    lines: lines::Lines,
    segments: segments::Segments,
    sizes: sizes::Sizes,
    cross: cross::Cross,
    /// `None` where each strip has one bay.
    carry: Option<carry::Carry>,
    sort: sort::Sort,
}

impl TablePasses {
    /// `bays`: strips of some face have several bays. `marks`: where curves pass is asked for.
    pub(crate) fn new(device: &Device, bays: bool, marks: bool) -> Result<Self, GpuError> {
        Ok(Self {
            density: density::Density::new(device, bays)?,
            lines: lines::Lines::new(device, bays)?,
            segments: segments::Segments::new(device, bays)?,
            sizes: sizes::Sizes::new(device, bays)?,
            cross: cross::Cross::new(device, bays, marks)?,
            carry: bays.then(|| carry::Carry::new(device)).transpose()?,
            sort: sort::Sort::new(device, bays)?,
        })
    }
}

/// What the passes work on.
#[derive(Clone, Copy)]
pub(crate) struct TableParts<'a> {
    pub passes: &'a TablePasses,
    pub scene: &'a TableScene,
    pub buffers: &'a TableBuffers,
}

impl<'a> TableParts<'a> {
    /// What the look-up reads, in the order of `glsl/include/trim.glsl`.
    pub(crate) fn test(self) -> Vec<Resource<'a>> {
        let t = self.buffers;
        [&t.strips, &t.rows, &t.intercepts, &t.border_cells].map(Resource::from).to_vec()
    }

    /// Records the passes; what the trim test reads is then ready for it.
    pub(crate) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let (s, b) = (frame.scene, frame.buffers);
        let (p, trims, t) = (self.passes, self.scene, self.buffers);
        let (w, r) = WRITE_TO_READ;
        let cleared = (Access::TRANSFER_WRITE, Access::COMPUTE_WRITE);
        let all_cleared: Vec<_> = t.cleared().map(|buffer| (buffer, cleared.0, cleared.1)).collect();
        barrier::buffers(cmd, &all_cleared);
        let seen_bays = t.bays.as_ref().map(|bays| &bays.seen);
        let row_windings = t.bays.as_ref().map(|bays| &bays.row_windings);
        let (constants, views) =
            frame.table_view.map_or((frame.constants, frame.views), |wider| (&wider.constants, &wider.views));
        let density = density::Bindings {
            frame: constants,
            views,
            instances: &s.instances,
            face_instances: &s.face_instances,
            faces: &s.faces,
            cells: &trims.cells,
            cell_items: &trims.cell_items,
            strip_heights: &t.strip_heights,
            face_speeds: &t.face_speeds,
            seen_bays,
        };
        p.density.record(cmd, &density, b.counts.cells);
        barrier::buffers(cmd, &[(&t.strip_heights, w, r), (&t.face_speeds, w, r)]);
        if let Some(seen) = seen_bays {
            barrier::buffers(cmd, &[(seen, w, r)]);
        }

        let lines = lines::Bindings {
            frame: frame.constants,
            strip_heights: &t.strip_heights,
            strip_counts: &t.strip_counts,
            counters: &b.counters,
            seen_bays,
        };
        p.lines.record(cmd, &lines, b.counts.bays);
        barrier::buffers(cmd, &[(&t.strip_counts, w, r), (&b.counters, w, w)]);
        frame.scan(cmd, &t.strip_counts, &t.strip_starts, b.counts.bays);
        barrier::buffers(cmd, &[(&t.strip_starts, w, r)]);

        let segments = segments::Bindings {
            frame: frame.constants,
            face_instances: &s.face_instances,
            faces: &s.faces,
            curves: &trims.curves,
            curve_items: &trims.curve_items,
            strip_starts: &t.strip_starts,
            face_speeds: &t.face_speeds,
            segment_counts: &t.segment_counts,
            seen_bays,
        };
        p.segments.record(cmd, &segments, b.counts.curves);
        barrier::buffers(cmd, &[(&t.segment_counts, w, r)]);
        frame.scan(cmd, &t.segment_counts, &t.segment_starts, b.counts.curves);
        barrier::buffers(cmd, &[(&t.segment_starts, w, r)]);

        let sizes = sizes::Bindings {
            frame: frame.constants,
            strip_starts: &t.strip_starts,
            segment_starts: &t.segment_starts,
            dispatches: &t.dispatches,
            strips: &t.strips,
            counters: &b.counters,
            seen_bays,
        };
        p.sizes.record(cmd, &sizes, b.counts.bays);
        barrier::buffers(cmd, &[(&t.dispatches, w, Access::INDIRECT_READ), (&t.strips, w, r), (&b.counters, w, w)]);

        let cross = cross::Bindings {
            frame: frame.constants,
            face_instances: &s.face_instances,
            faces: &s.faces,
            curves: &trims.curves,
            curve_points: &trims.curve_points,
            curve_items: &trims.curve_items,
            strips: &t.strips,
            segment_starts: &t.segment_starts,
            row_starts: &t.row_starts,
            row_counts: &t.rows,
            intercepts: &t.intercepts,
            border_cells: &t.border_cells,
            row_windings,
            dispatches: &t.dispatches,
        };
        p.cross.count(cmd, &cross);
        barrier::buffers(cmd, &[(&t.rows, w, r), (&t.row_starts, r, w), (&b.sums, w, w)]);
        let word = |offset: usize| (offset / size_of::<u32>()) as u32;
        frame.passes.scan.record(
            cmd,
            scan::Count::Gpu {
                counts: &b.counters,
                index: word(offset_of!(Counters, rows)),
                arguments: &t.dispatches,
                offset: 2 * size_of::<[u32; 3]>() as u64,
                capacity: b.capacities.rows,
            },
            &scan::Bindings {
                values: &t.rows,
                offsets: &t.row_starts,
                sums: &b.sums,
                total: &t.row_total,
                total_index: 0,
            },
        );
        barrier::buffers(cmd, &[(&t.row_starts, w, r), (&t.row_total, w, r), (&t.rows, r, w), (&b.counters, r, w)]);
        if let Some(((carry, bays), wide_strips)) =
            p.carry.as_ref().zip(t.bays.as_ref()).zip(trims.wide_strips.as_ref())
        {
            let row_windings = &bays.row_windings;
            barrier::buffers(cmd, &[(row_windings, w, Access::COMPUTE_READ | Access::COMPUTE_WRITE)]);
            let bindings = carry::Bindings { frame: frame.constants, strips: &t.strips, wide_strips, row_windings };
            carry.record(cmd, &bindings, b.counts.wide_strips);
            barrier::buffers(cmd, &[(row_windings, w, r)]);
        }
        p.cross.insert(cmd, &cross);
        barrier::buffers(cmd, &[(&t.intercepts, w, w), (&t.rows, w, w)]);

        let sort = sort::Bindings {
            frame: frame.constants,
            row_starts: &t.row_starts,
            row_total: &t.row_total,
            rows: &t.rows,
            intercepts: &t.intercepts,
            counters: &b.counters,
            row_windings,
            dispatches: &t.dispatches,
        };
        p.sort.record(cmd, &sort);
        barrier::buffers(
            cmd,
            &[
                (&t.strips, w, Access::FRAGMENT_READ | Access::COMPUTE_READ),
                (&t.rows, w, Access::FRAGMENT_READ | Access::COMPUTE_READ),
                (&t.intercepts, w, Access::FRAGMENT_READ | Access::COMPUTE_READ),
                (&t.border_cells, w, Access::FRAGMENT_READ | Access::COMPUTE_READ),
            ],
        );
    }
}
