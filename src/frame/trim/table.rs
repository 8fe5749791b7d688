//! The trim table: the u-intercepts of this view and of all views that the table serves.
//!
//! ```text
//!   cells ──density──▶ strip heights ──lines──(scan)──▶ rows
//!   curves ──segments──(scan)──▶ chords ──dispatch_arguments──▶ dispatches
//!   chords ──cross: count──(scan)──▶ cross: insert──▶ intercepts ──sort──▶ flips of each row
//!                 ╰──▶ row windings ──carry──▶ windings at row starts ──╯     only if strips have several bins
//! ```
//!
//! A table stays valid until a view that it does not serve (`scene::trimmed`), or an edit; `src/frame/reuse.rs`
//! restores it.

use super::{carry, cross, density, dispatch_arguments, lines, segments, sort};
use crate::abi::{BORDER_BANDS, BORDER_COLUMNS, Counters, StripRows};
use crate::frame::common::room::Room;
use crate::frame::common::scan;
use crate::frame::{Frame, WRITE_TO_READ};
use crate::gpu::{Access, Buffer, Commands, Device, GpuError, Resource, Texel, TexelBuffer, barrier};
use crate::scene::SceneData;
use std::mem::offset_of;
use std::sync::Arc;

/// The cells of a bin that curves cross, one bit a cell: `glsl/include/border_cells.glsl`.
pub(crate) type BorderCells = [u8; (BORDER_BANDS * BORDER_COLUMNS / 8) as usize];

/// The passes of the trim table.
pub(crate) struct Passes {
    density: density::Density,
    lines: lines::Lines,
    segments: segments::Segments,
    dispatch_arguments: dispatch_arguments::DispatchArguments,
    cross: cross::Cross,
    sort: sort::Sort,
    /// `None` if each strip has one bin.
    carry: Option<Arc<carry::Carry>>,
}

impl Passes {
    pub(crate) fn new(device: &Device, data: &SceneData) -> Result<Self, GpuError> {
        // strips of some face have several bins
        let bins = !data.wide_strips.is_empty();
        Ok(Self {
            density: density::Density::new(device, bins)?,
            lines: lines::Lines::new(device, bins)?,
            segments: segments::Segments::new(device, bins)?,
            dispatch_arguments: dispatch_arguments::DispatchArguments::new(device, bins)?,
            // passes for operands read the cells that curves cross
            cross: cross::Cross::new(device, bins, data.has_operands)?,
            sort: sort::Sort::new(device, bins)?,
            carry: bins.then(|| carry::Carry::new(device)).transpose()?.map(Arc::new),
        })
    }
}

/// The passes, the table, and the buffers from which it is made.
pub(crate) struct Table {
    passes: Arc<Passes>,
    strip_heights: Buffer,
    face_speeds: Buffer,
    strip_counts: Buffer,
    strip_starts: TexelBuffer,
    segment_counts: Buffer,
    segment_starts: TexelBuffer,
    dispatches: Buffer,
    strips: TexelBuffer,
    /// While rows are filled: the number of intercepts of each, one word a row. Then for each row its first flip, and
    /// its number of flips twice, plus 1 if it starts inside.
    rows: TexelBuffer,
    row_starts: TexelBuffer,
    row_total: Buffer,
    intercepts: TexelBuffer,
    /// Written only in scenes with spline operands, whose passes read it.
    border_cells: TexelBuffer,
    /// `None` if each strip has one bin.
    bins: Option<Bins>,
    /// The counters when the table was made.
    pub counters: Buffer,
}

/// The buffers of strips with several bins.
struct Bins {
    carry: Arc<carry::Carry>,
    seen: Buffer,
    row_windings: Buffer,
}

impl Table {
    pub(crate) fn new(room: &Room<'_>, passes: &Arc<Passes>) -> Result<Self, GpuError> {
        let (counts, capacities) = (room.counts, room.capacities.trim);
        let bins = |carry: &Arc<carry::Carry>| {
            Ok::<_, GpuError>(Bins {
                carry: Arc::clone(carry),
                seen: room.words("trim seen bins", counts.bins)?,
                row_windings: room.words("trim row windings", capacities.rows)?,
            })
        };
        let marked = if counts.operand_patches { counts.bins } else { 1 };
        Ok(Self {
            strip_heights: room.words("trim strip heights", counts.bins)?,
            face_speeds: room.words("trim face speeds", 2 * counts.face_instances)?,
            strip_counts: room.words("trim strip counts", counts.bins)?,
            strip_starts: room.texels::<u32>("trim strip starts", counts.bins + 1, Texel::Words)?,
            segment_counts: room.words("trim segment counts", counts.curves)?,
            segment_starts: room.texels::<u32>("trim segment starts", counts.curves + 1, Texel::Words)?,
            dispatches: room.indirect::<[u32; 3]>("trim dispatches", 3)?,
            strips: room.texels::<StripRows>("trim strips", counts.bins, Texel::U32x4)?,
            rows: room.texels::<[u32; 2]>("trim rows", capacities.rows, Texel::U32x2)?,
            row_starts: room.texels::<u32>("trim row starts", capacities.rows, Texel::Words)?,
            row_total: room.words("trim row total", 1)?,
            intercepts: room.texels::<u32>("trim intercepts", capacities.intercepts, Texel::U32x2)?,
            border_cells: room.texels::<BorderCells>("trim border cells", marked, Texel::U32x4)?,
            bins: passes.carry.as_ref().map(bins).transpose()?,
            counters: room.structs::<Counters>("trim table counters", 1)?,
            passes: Arc::clone(passes),
        })
    }

    /// Clears the passes' counters.
    pub(crate) fn begin(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        if !frame.reuses_table {
            self.counted().for_each(|buffer| cmd.fill(buffer, 0));
        }
    }

    /// The buffers that are zero when the frame begins.
    fn counted(&self) -> impl Iterator<Item = &Buffer> {
        let of_bins = self.bins.iter().flat_map(|bins| [&bins.seen, &bins.row_windings]);
        let all: [&Buffer; 4] = [&self.strip_heights, &self.face_speeds, &self.rows, &self.border_cells];
        all.into_iter().chain(of_bins)
    }

    /// The buffers of the look-up, in the order of `glsl/include/trim.glsl`.
    pub(crate) fn test(&self) -> Vec<Resource<'_>> {
        [&self.strips, &self.rows, &self.intercepts, &self.border_cells].map(Resource::from).to_vec()
    }

    /// Records the passes, and the barrier before the trim test.
    pub(crate) fn record(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let Some(trims) = frame.scene.table() else { return };
        let (s, b, counts) = (frame.scene, &frame.stages.common, frame.counts);
        let (p, t) = (&self.passes, self);
        let (w, r) = WRITE_TO_READ;
        let cleared = (Access::TRANSFER_WRITE, Access::COMPUTE_WRITE);
        let all_cleared: Vec<_> = t.counted().map(|buffer| (buffer, cleared.0, cleared.1)).collect();
        barrier::buffers(cmd, &all_cleared);
        let seen_bins = t.bins.as_ref().map(|bins| &bins.seen);
        let row_windings = t.bins.as_ref().map(|bins| &bins.row_windings);
        let (constants, views) =
            frame.table_view.map_or((frame.constants, frame.views), |wider| (&wider.constants, &wider.views));
        let density = density::Bindings {
            frame: constants,
            views,
            instances: &s.instances,
            face_instances: &s.face_instances,
            faces: &s.faces,
            cells: &trims.cells,
            cell_instances: &trims.cell_instances,
            strip_heights: &t.strip_heights,
            face_speeds: &t.face_speeds,
            seen_bins,
        };
        p.density.record(cmd, &density, counts.cells);
        cmd.after(w, r);

        let lines = lines::Bindings {
            frame: frame.constants,
            strip_heights: &t.strip_heights,
            strip_counts: &t.strip_counts,
            counters: &b.counters,
            seen_bins,
        };
        p.lines.record(cmd, &lines, counts.bins);
        cmd.after(w, r | w);
        b.scan(cmd, &t.strip_counts, &t.strip_starts, counts.bins);
        cmd.after(w, r);

        let segments = segments::Bindings {
            frame: frame.constants,
            face_instances: &s.face_instances,
            faces: &s.faces,
            curves: &trims.curves,
            curve_instances: &trims.curve_instances,
            strip_starts: &t.strip_starts,
            face_speeds: &t.face_speeds,
            segment_counts: &t.segment_counts,
            seen_bins,
        };
        p.segments.record(cmd, &segments, counts.curves);
        cmd.after(w, r);
        b.scan(cmd, &t.segment_counts, &t.segment_starts, counts.curves);
        cmd.after(w, r);

        let arguments = dispatch_arguments::Bindings {
            frame: frame.constants,
            strip_starts: &t.strip_starts,
            segment_starts: &t.segment_starts,
            dispatches: &t.dispatches,
            strips: &t.strips,
            counters: &b.counters,
            seen_bins,
        };
        p.dispatch_arguments.record(cmd, &arguments, counts.bins);
        cmd.after(w, Access::INDIRECT_READ | r | w);

        let cross = cross::Bindings {
            frame: frame.constants,
            face_instances: &s.face_instances,
            faces: &s.faces,
            curves: &trims.curves,
            curve_points: &trims.curve_points,
            curve_instances: &trims.curve_instances,
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
        cmd.after(w, r | w);
        let word = |offset: usize| (offset / size_of::<u32>()) as u32;
        b.passes.scan.record(
            cmd,
            scan::Count::Gpu {
                counts: &b.counters,
                index: word(offset_of!(Counters, rows)),
                arguments: &t.dispatches,
                offset: 2 * size_of::<[u32; 3]>() as u64,
                capacity: frame.capacities.trim.rows,
            },
            &scan::Bindings {
                values: &t.rows,
                offsets: &t.row_starts,
                sums: &b.sums,
                total: &t.row_total,
                total_index: 0,
            },
        );
        cmd.after(w, r | w);
        if let (Some(bins), Some(wide_strips)) = (&t.bins, &trims.wide_strips) {
            let row_windings = &bins.row_windings;
            let bindings = carry::Bindings { frame: frame.constants, strips: &t.strips, wide_strips, row_windings };
            bins.carry.record(cmd, &bindings, counts.wide_strips);
            cmd.after(w, r);
        }
        p.cross.insert(cmd, &cross);
        cmd.after(w, w);

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
        cmd.after(w, Access::FRAGMENT_READ | Access::COMPUTE_READ);
    }
}
