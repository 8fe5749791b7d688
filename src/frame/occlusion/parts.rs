//! Placed parts that other surfaces hide as a whole: no pass looks at their patches. A part of many patches has
//! several groups of faces (`scene/in_sight.rs`); each group counts as a part here.
//!
//! ```text
//!   parts in sight ─▶ part_counts ──(scan)──▶ part_runs: runs of patch instances, dispatches      a list of parts
//!
//!   list "first"      parts that were not hidden in the previous frame ─▶ bound … visibility
//!                                                                            │ depth_pyramid
//!   cull_parts        which parts are hidden now? ◀──────────────────────────┘
//!   list "appearing"  parts that were hidden and are no longer ─▶ bound; all of their patches count as hidden
//!   list "all"        both ─▶ cull_late … visibility again
//! ```
//!
//! A part is hidden if every pixel of a rectangle shows something nearer than a depth. Rectangle and depth come from
//! a box around everything that is drawn of the part (`scene/in_sight/drawn.rs`). So every fragment of the part would
//! fail the depth test. Its skirts store their depths without a depth test, but they lie behind the visible surface and
//! do not count there (`twin::occlusion`). So the picture is the same bit for bit, with the exceptions in
//! `docs/design/culling.md`. A part that was hidden and is no longer certainly hidden is drawn in the same frame.
//!
//! The lists are made on the GPU, so passes over patches take their number of threads from there
//! ([`Threads::Gpu`]).

use super::cull_early::{self, CullEarly};
use super::cull_parts::{self, CullParts};
use super::part_counts::{self, PartCounts};
use super::part_runs::{self, PartRuns};
use crate::abi::{LIST_ALL, LIST_APPEARING, ListDispatches, PartList, PatchRun};
use crate::frame::common::PatchList;
use crate::frame::common::kernel::Threads;
use crate::frame::common::room::Room;
use crate::frame::{Frame, WRITE_TO_READ};
use crate::gpu::{Access, Buffer, Commands, Device, GpuError};
use crate::scene::SceneData;
use std::sync::Arc;

/// The passes.
pub(crate) struct Passes {
    counts: PartCounts,
    runs: PartRuns,
    cull: CullParts,
    /// For parts that appear: all of their patches were hidden.
    cull_all: CullEarly,
}

impl Passes {
    /// `None` in scenes without occlusion culling of parts.
    pub(super) fn new(device: &Device, data: &SceneData) -> Result<Option<Self>, GpuError> {
        if !data.hides_parts() {
            return Ok(None);
        }
        Ok(Some(Self {
            counts: PartCounts::new(device)?,
            runs: PartRuns::new(device)?,
            cull: CullParts::new(device)?,
            cull_all: CullEarly::new(device, true)?,
        }))
    }
}

/// Their buffers.
pub(crate) struct Parts {
    passes: Arc<Passes>,
    /// One word a group of faces of a placed part: whether it was hidden in the previous frame that had it in sight,
    /// and whether it is now.
    hidden_before: Buffer,
    hidden_now: Buffer,
    /// Two words a group in sight, and their prefix sums.
    counts: Buffer,
    starts: Buffer,
    runs: Buffer,
    dispatches: Buffer,
}

impl Parts {
    pub(super) fn new(room: &Room<'_>, passes: &Arc<Passes>) -> Result<Self, GpuError> {
        let n = room.counts.placed_groups;
        Ok(Self {
            passes: Arc::clone(passes),
            hidden_before: room.words("parts hidden before", n)?,
            hidden_now: room.words("parts hidden now", n)?,
            counts: room.words("counts of parts", 2 * n)?,
            starts: room.words("starts of parts", 2 * n + 1)?,
            runs: room.structs::<PatchRun>("runs of listed parts", n)?,
            dispatches: room.indirect::<ListDispatches>("dispatches of listed parts", 1)?,
        })
    }

    /// In a first frame no part is hidden.
    pub(super) fn begin(&self, cmd: &Commands<'_>) {
        cmd.fill(&self.hidden_now, 0);
    }

    /// The patch instances of the last list.
    pub(super) fn patch_list(&self) -> PatchList<'_> {
        PatchList { runs: &self.runs, threads: Threads::Gpu(&self.dispatches) }
    }

    /// Makes a list, one of `LIST_*`. Passes of the list before may still be at work.
    pub(super) fn list(&self, frame: &Frame<'_>, cmd: &Commands<'_>, list: u32) {
        let (parts_in_sight, parts) = frame.parts_in_sight();
        let common = &frame.stages.common;
        let (w, r) = WRITE_TO_READ;
        let push = PartList { parts, list };
        let counts = part_counts::Bindings {
            parts_in_sight,
            hidden_before: &self.hidden_before,
            hidden_now: &self.hidden_now,
            counts: &self.counts,
            counters: &common.counters,
        };
        cmd.after(Access::TRANSFER_WRITE | Access::INDIRECT_READ | w, w);
        self.passes.counts.record(cmd, &counts, push);
        common.scan(cmd, &self.counts, &self.starts, 2 * parts);
        let runs = part_runs::Bindings {
            frame: frame.constants,
            parts_in_sight,
            counts: &self.counts,
            starts: &self.starts,
            runs: &self.runs,
            dispatches: &self.dispatches,
            counters: &common.counters,
        };
        cmd.after(w | Access::UNIFORM_READ, w);
        self.passes.runs.record(cmd, &runs, push);
        cmd.after(w, r | w | Access::UNIFORM_READ | Access::INDIRECT_READ);
    }

    /// Finds the parts that are hidden behind `farthest` depths.
    pub(super) fn cull(&self, frame: &Frame<'_>, cmd: &Commands<'_>, farthest: &Buffer) {
        let (parts_in_sight, parts) = frame.parts_in_sight();
        let hidden_now = &self.hidden_now;
        let bindings = cull_parts::Bindings { frame: frame.constants, parts_in_sight, farthest, hidden_now };
        self.passes.cull.record(cmd, &bindings, parts);
    }

    /// After [`cull`](Self::cull): divides the patches of parts that appear, and lists them with the others. `hidden`:
    /// of patches; not read here.
    pub(super) fn appear(&self, frame: &Frame<'_>, cmd: &Commands<'_>, hidden: &Buffer) {
        let w = WRITE_TO_READ.0;
        self.list(frame, cmd, LIST_APPEARING);
        frame.stages.tessellation.divide(frame, cmd);
        cmd.after(w, w);
        let (taus, counters) = (&frame.stages.tessellation.taus, &frame.stages.common.counters);
        let PatchList { runs, threads } = self.patch_list();
        let bindings = cull_early::Bindings { frame: frame.constants, hidden, taus, counters, runs };
        self.passes.cull_all.record(cmd, &bindings, threads);
        self.list(frame, cmd, LIST_ALL);
    }
}
