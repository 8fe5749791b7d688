//! The frame's part for what a still camera keeps: the patches as they were divided, and the trim table.
//!
//! ```text
//!   a new view, an edit, new buffers     ──▶ reset ─▶ tessellation ─▶ trim table ─▶ mesh … layers
//!                                                                        │ counters
//!                                                                        ▼
//!                                                                  kept counters
//!                                                                        │ counters
//!                                                                        ▼
//!   the view of the frame before, again  ──▶ ────────────────────────────●────────▶ mesh … layers
//! ```
//!
//! What these passes write hangs on the view, the settings, the scene and the room that there is, and drawing writes none
//! of it but the counters: while all of that stays, so do factors, sub-patches, draws and table in their buffers, and
//! making them once more would give the same words. `renderer::known` says when. Counters are those of these passes again, as
//! they were before anything was drawn: counts that drawing adds to, clamps and what did not fit among them, begin where
//! they would have, and a table that had no room is told again by every frame that is drawn from it.

use super::{COPIED, Frame};
use crate::abi::Counters;
use crate::gpu::{Access, Buffer, Commands, Timestamps, barrier};

impl Frame<'_> {
    /// What is drawn from: made now, or kept.
    pub(super) fn prepare(&self, cmd: &Commands<'_>, times: &mut Timestamps) {
        self.clear(cmd);
        match &self.buffers.kept_counters {
            Some(kept) if self.keeps => self.take_up(cmd, kept),
            Some(kept) => {
                self.make(cmd, times);
                self.leave(cmd, kept);
            }
            None => self.make(cmd, times),
        }
    }

    /// For frames to come.
    fn leave(&self, cmd: &Commands<'_>, kept: &Buffer) {
        let counters = &self.buffers.counters;
        barrier::buffers(cmd, &[(counters, Access::COMPUTE_WRITE, COPIED)]);
        cmd.copy(counters, 0, kept, 0, size_of::<Counters>() as u64);
        barrier::buffers(
            cmd,
            &[(counters, COPIED, Access::COMPUTE_WRITE), (kept, Access::TRANSFER_WRITE, Access::TRANSFER_READ)],
        );
    }

    /// From the frame before.
    fn take_up(&self, cmd: &Commands<'_>, kept: &Buffer) {
        let counters = &self.buffers.counters;
        cmd.copy(kept, 0, counters, 0, size_of::<Counters>() as u64);
        let counted = Access::COMPUTE_WRITE | Access::INDIRECT_READ;
        barrier::buffers(cmd, &[(counters, Access::TRANSFER_WRITE, counted)]);
    }
}
