//! Reuse of the previous frame's results: the visibility of each pixel, and the trim table.
//!
//! ```text
//!   a new view, an edit, new buffers   ──▶ reset ─▶ trim table ─▶ tessellation ─▶ mesh … gaps ─▶ resolve … layers
//!                                                   │ counters       ┊            │ counters
//!                                                   ▼                ┊            ▼
//!                                             counters of the        ┊    stored counters
//!                                             table │                ┊            │
//!                                                   │ counters       ┊            │
//!   a view that the table serves       ──▶ reset ───●───────▶ tessellation ─ …    │ counters
//!                                                 several samples a pixel: here   │
//!   the same view as the frame before  ──▶ ─────────────────────────┴────────────●────────────▶ resolve … layers
//! ```
//!
//! The results of these passes depend only on the view, the settings, the scene and the buffers' sizes, and later
//! passes change only the counters. So while all of these stay the same, sub-patches, draws, table, lists, visibility
//! and depth are still valid, and making them again would give the same bits. `renderer::history` decides when that
//! holds. The host's targets are drawn in every frame. Samples share one visibility image, so samples are drawn in
//! every frame, too, from the same patches and table.
//!
//! Counters start with their values after the reused passes. Every frame thus reports the counts of a whole frame,
//! including clamps and lists that were too short.

use super::Frame;
use super::trim::table::Table;
use crate::abi::Counters;
use crate::gpu::{Access, Buffer, Commands, barrier};

/// Accesses to the counters before and after.
fn counted() -> Access {
    Access::COMPUTE_WRITE | Access::INDIRECT_READ
}

impl Frame<'_> {
    /// Records the passes of a new view and stores their counters; or restores the counters of the previous frame.
    pub(super) fn unless_view_reused(&self, cmd: &Commands<'_>, record: impl FnOnce()) {
        self.unless_reused(cmd, (self.reuses_view, &self.stages.common.counters_of_view), record);
    }

    /// The same for the trim table, at the start of a view, when nothing has been counted yet.
    pub(super) fn unless_table_reused(&self, cmd: &Commands<'_>, table: &Table, record: impl FnOnce()) {
        self.unless_reused(cmd, (self.reuses_table, &table.counters), record);
    }

    fn unless_reused(&self, cmd: &Commands<'_>, (is_reused, stored): (bool, &Buffer), record: impl FnOnce()) {
        let counters = &self.stages.common.counters;
        let bytes = size_of::<Counters>() as u64;
        if is_reused {
            barrier::buffers(cmd, &[(counters, counted(), Access::TRANSFER_WRITE)]);
            cmd.copy(stored, 0, counters, 0, bytes);
            barrier::buffers(cmd, &[(counters, Access::TRANSFER_WRITE, counted())]);
            return;
        }
        record();
        barrier::buffers(cmd, &[(counters, counted(), Access::TRANSFER_READ)]);
        cmd.copy(counters, 0, stored, 0, bytes);
        barrier::buffers(
            cmd,
            &[
                (counters, Access::TRANSFER_READ, Access::COMPUTE_WRITE),
                (stored, Access::TRANSFER_WRITE, Access::TRANSFER_READ),
            ],
        );
    }
}
