//! What stays from frame to frame: what each pixel sees, and the trim table.
//!
//! ```text
//!   a new view, an edit, new buffers   ──▶ reset ─▶ trim table ─▶ tessellation ─▶ mesh … heal ─▶ resolve … layers
//!                                                   │ counters       ┊            │ counters
//!                                                   ▼                ┊            ▼
//!                                             counters of the        ┊      kept counters
//!                                             table │                ┊            │
//!                                                   │ counters       ┊            │
//!   a view that the table serves       ──▶ reset ───●───────▶ tessellation ─ …    │ counters
//!                                                 several samples a pixel: here   │
//!   the view of the frame before, again ──▶ ─────────────────────────┴────────────●────────────▶ resolve … layers
//! ```
//!
//! What these passes write hangs on the view, the settings, the scene and the room that there is, and what comes after them
//! writes none of it but the counters: while all of that stays, so do sub-patches, draws, table, lists, visibility and depth
//! where they are, and making them once more would give the same bits. `renderer::history` says when. The host's targets are
//! another matter: they are drawn into in every frame. Samples share one visibility image, so those are drawn in every
//! frame, too, from the patches and the table.
//!
//! Counters begin as they were after what is kept: counts that go on, clamps among them, are those of a whole frame, and
//! what had no room is told again by every frame that keeps it.

use super::Frame;
use super::trim::table::Table;
use crate::abi::Counters;
use crate::gpu::{Access, Buffer, Commands, barrier};

/// Who touches counters before and after.
fn counted() -> Access {
    Access::COMPUTE_WRITE | Access::INDIRECT_READ
}

impl Frame<'_> {
    /// Records what this view is made of, for frames to come; or takes up what the frame before left.
    pub(super) fn unless_seen(&self, cmd: &Commands<'_>, record: impl FnOnce()) {
        self.unless_kept(cmd, (self.keeps, &self.stages.common.kept_counters), record);
    }

    /// The same of the trim table, at the beginning of a view: nothing has been counted yet.
    pub(super) fn unless_made(&self, cmd: &Commands<'_>, table: &Table, record: impl FnOnce()) {
        self.unless_kept(cmd, (self.keeps_table, &table.counters), record);
    }

    fn unless_kept(&self, cmd: &Commands<'_>, (keeps, kept): (bool, &Buffer), record: impl FnOnce()) {
        let counters = &self.stages.common.counters;
        let bytes = size_of::<Counters>() as u64;
        if keeps {
            barrier::buffers(cmd, &[(counters, counted(), Access::TRANSFER_WRITE)]);
            cmd.copy(kept, 0, counters, 0, bytes);
            barrier::buffers(cmd, &[(counters, Access::TRANSFER_WRITE, counted())]);
            return;
        }
        record();
        barrier::buffers(cmd, &[(counters, counted(), Access::TRANSFER_READ)]);
        cmd.copy(counters, 0, kept, 0, bytes);
        barrier::buffers(
            cmd,
            &[
                (counters, Access::TRANSFER_READ, Access::COMPUTE_WRITE),
                (kept, Access::TRANSFER_WRITE, Access::TRANSFER_READ),
            ],
        );
    }
}
