//! The frame's part for the trim table: the u-intercepts of this view.
//!
//! ```text
//!   cells ──density──▶ strip heights ──lines──(scan)──▶ rows
//!   curves ──segments──(scan)──▶ chords ──sizes──▶ dispatches
//!   chords ──cross: count──(scan)──▶ cross: insert──▶ intercepts ──sort──▶ flips of each row
//! ```

use super::{Frame, WRITE_TO_READ};
use crate::abi::Counters;
use crate::buffers::TableBuffers;
use crate::gpu::{Access, Commands, Device, GpuError, Resource, barrier};
use crate::passes::{cross, density, lines, scan, segments, sizes, sort};
use crate::scene::TableScene;
use std::mem::offset_of;

/// The passes of the trim table.
pub(super) struct TablePasses {
    density: density::Density,
    lines: lines::Lines,
    segments: segments::Segments,
    sizes: sizes::Sizes,
    cross: cross::Cross,
    sort: sort::Sort,
}

impl TablePasses {
    /// `hides`: patches may lie behind others.
    pub(super) fn new(device: &Device, hides: bool) -> Result<Self, GpuError> {
        Ok(Self {
            density: density::Density::new(device, hides)?,
            lines: lines::Lines::new(device)?,
            segments: segments::Segments::new(device)?,
            sizes: sizes::Sizes::new(device)?,
            cross: cross::Cross::new(device)?,
            sort: sort::Sort::new(device)?,
        })
    }
}

/// What the passes work on.
#[derive(Clone, Copy)]
pub(super) struct TableParts<'a> {
    pub passes: &'a TablePasses,
    pub scene: &'a TableScene,
    pub buffers: &'a TableBuffers,
}

impl<'a> TableParts<'a> {
    /// What the look-up reads, in the order of `glsl/include/trim.glsl`.
    pub(super) fn test(self) -> Vec<Resource<'a>> {
        let t = self.buffers;
        [&t.strips, &t.row_starts, &t.row_counts, &t.intercepts, &t.border_cells].map(Resource::from).to_vec()
    }

    /// Records the passes; what the trim test reads is then ready for it.
    pub(super) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let (s, b) = (frame.scene, frame.buffers);
        let (p, trims, t) = (self.passes, self.scene, self.buffers);
        let (w, r) = WRITE_TO_READ;
        let cleared = (Access::TRANSFER_WRITE, Access::COMPUTE_WRITE);
        barrier::buffers(
            cmd,
            &[
                (&t.strip_heights, cleared.0, cleared.1),
                (&t.face_speeds, cleared.0, cleared.1),
                (&t.row_counts, cleared.0, cleared.1),
                (&t.border_cells, cleared.0, cleared.1),
            ],
        );
        let density = density::Bindings {
            frame: frame.constants,
            views: frame.views,
            instances: &s.instances,
            face_instances: &s.face_instances,
            faces: &s.faces,
            cells: &trims.cells,
            cell_items: &trims.cell_items,
            strip_heights: &t.strip_heights,
            face_speeds: &t.face_speeds,
            drawn_faces: frame.hidden().map(|parts| parts.drawn_faces()),
        };
        p.density.record(cmd, &density, b.counts.cells);
        barrier::buffers(cmd, &[(&t.strip_heights, w, r), (&t.face_speeds, w, r)]);

        let lines = lines::Bindings {
            frame: frame.constants,
            strip_heights: &t.strip_heights,
            line_counts: &t.line_counts,
            counters: &b.counters,
        };
        p.lines.record(cmd, &lines, b.counts.strips);
        barrier::buffers(cmd, &[(&t.line_counts, w, r), (&b.counters, w, w)]);
        frame.scan(cmd, &t.line_counts, &t.line_starts, b.counts.strips);
        barrier::buffers(cmd, &[(&t.line_starts, w, r)]);

        let segments = segments::Bindings {
            frame: frame.constants,
            face_instances: &s.face_instances,
            faces: &s.faces,
            curves: &trims.curves,
            curve_items: &trims.curve_items,
            line_starts: &t.line_starts,
            face_speeds: &t.face_speeds,
            segment_counts: &t.segment_counts,
        };
        p.segments.record(cmd, &segments, b.counts.curves);
        barrier::buffers(cmd, &[(&t.segment_counts, w, r)]);
        frame.scan(cmd, &t.segment_counts, &t.segment_starts, b.counts.curves);
        barrier::buffers(cmd, &[(&t.segment_starts, w, r)]);

        let sizes = sizes::Bindings {
            frame: frame.constants,
            line_starts: &t.line_starts,
            segment_starts: &t.segment_starts,
            dispatches: &t.dispatches,
            strips: &t.strips,
            counters: &b.counters,
        };
        p.sizes.record(cmd, &sizes, b.counts.strips);
        barrier::buffers(cmd, &[(&t.dispatches, w, Access::INDIRECT_READ), (&b.counters, w, w)]);

        let cross = cross::Bindings {
            frame: frame.constants,
            face_instances: &s.face_instances,
            faces: &s.faces,
            curves: &trims.curves,
            curve_points: &trims.curve_points,
            curve_items: &trims.curve_items,
            line_starts: &t.line_starts,
            segment_starts: &t.segment_starts,
            row_starts: &t.row_starts,
            row_counts: &t.row_counts,
            intercepts: &t.intercepts,
            border_cells: &t.border_cells,
            dispatches: &t.dispatches,
        };
        p.cross.count(cmd, &cross);
        barrier::buffers(cmd, &[(&t.row_counts, w, r), (&t.row_starts, r, w), (&b.sums, w, w)]);
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
                values: &t.row_counts,
                offsets: &t.row_starts,
                sums: &b.sums,
                total: &t.row_total,
                total_index: 0,
            },
        );
        barrier::buffers(
            cmd,
            &[(&t.row_starts, w, r), (&t.row_total, w, r), (&t.row_counts, r, w), (&b.counters, r, w)],
        );
        p.cross.insert(cmd, &cross);
        barrier::buffers(cmd, &[(&t.intercepts, w, w), (&t.row_counts, w, w)]);

        let sort = sort::Bindings {
            frame: frame.constants,
            row_starts: &t.row_starts,
            row_total: &t.row_total,
            row_counts: &t.row_counts,
            intercepts: &t.intercepts,
            counters: &b.counters,
            dispatches: &t.dispatches,
        };
        p.sort.record(cmd, &sort);
        barrier::buffers(
            cmd,
            &[
                (&t.strips, w, Access::FRAGMENT_READ | Access::COMPUTE_READ),
                (&t.row_starts, w, Access::FRAGMENT_READ | Access::COMPUTE_READ),
                (&t.row_counts, w, Access::FRAGMENT_READ | Access::COMPUTE_READ),
                (&t.intercepts, w, Access::FRAGMENT_READ | Access::COMPUTE_READ),
                (&t.border_cells, w, Access::FRAGMENT_READ | Access::COMPUTE_READ),
            ],
        );
    }
}
