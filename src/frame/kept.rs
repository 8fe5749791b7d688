//! The frame's part for what a still camera keeps: what each pixel sees.
//!
//! ```text
//!   a new view, an edit, new buffers   ──▶ reset ─▶ tessellation ─▶ trim table ─▶ mesh … heal ─▶ resolve … layers
//!                                                                     ┊           │ counters
//!                                                several samples a pixel: here    ▼
//!                                                                     ┊     kept counters
//!                                                                     ┊           │ counters
//!   the view of the frame before, again ──▶ ──────────────────────────┴───────────●────────────▶ resolve … layers
//! ```
//!
//! What these passes write hangs on the view, the settings, the scene and the room that there is, and what comes after them
//! writes none of it but the counters: while all of that stays, so do sub-patches, draws, table, lists, visibility and depth
//! where they are, and making them once more would give the same bits. `renderer::known` says when. The host's targets are
//! another matter: they are drawn into in every frame. Samples share one visibility image, so those are drawn in every
//! frame, too, from the patches and the table.
//!
//! Counters begin as they were after what is kept: counts that go on, clamps among them, are those of a whole frame, and
//! what had no room is told again by every frame that keeps it.

use super::{COPIED, Frame};
use crate::abi::Counters;
use crate::gpu::{Access, Commands, barrier};

/// Who touches counters before and after.
fn counted() -> Access {
    Access::COMPUTE_WRITE | Access::INDIRECT_READ
}

impl Frame<'_> {
    /// Records what this view is made of, for frames to come; or takes up what the frame before left.
    pub(super) fn unless_kept(&self, cmd: &Commands<'_>, record: impl FnOnce()) {
        let (counters, kept) = (&self.buffers.counters, &self.buffers.kept_counters);
        let bytes = size_of::<Counters>() as u64;
        if self.keeps {
            cmd.copy(kept, 0, counters, 0, bytes);
            barrier::buffers(cmd, &[(counters, Access::TRANSFER_WRITE, counted())]);
            return;
        }
        record();
        barrier::buffers(cmd, &[(counters, counted(), COPIED)]);
        cmd.copy(counters, 0, kept, 0, bytes);
        barrier::buffers(
            cmd,
            &[(counters, COPIED, Access::COMPUTE_WRITE), (kept, Access::TRANSFER_WRITE, Access::TRANSFER_READ)],
        );
    }
}
