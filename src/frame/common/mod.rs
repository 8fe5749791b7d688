//! Shared by several stages: counters that begin at 0, prefix sums, draws of sub-patches, and what two stages agree on.

pub(crate) mod border_list;
pub(crate) mod draw;
pub(crate) mod gate;
pub(crate) mod kernel;
pub(crate) mod later;
pub(crate) mod layer_faces;
pub(crate) mod line_items;
pub(crate) mod reset;
pub(crate) mod room;
pub mod scan;

use super::Frame;
use crate::abi::{Counters, ListDispatches};
use crate::gpu::{Access, Buffer, Commands, Device, GpuError, barrier};
use crate::picture::TakenWay;
use crate::scene::SceneData;
use ash::vk;
use kernel::Threads;
use room::Room;
use std::mem::offset_of;
use std::sync::Arc;

/// The passes.
pub(crate) struct Passes {
    reset: reset::Reset,
    pub(super) scan: scan::Scan,
    /// In scenes with patches.
    gate: Option<gate::Gate>,
}

impl Passes {
    pub(super) fn new(device: &Device, data: &SceneData) -> Result<Self, GpuError> {
        let counts_on_gpu = data.trim_way() == Some(TakenWay::Table) || data.hides_parts();
        let scan = scan::Scan::new(device, counts_on_gpu)?;
        let gate = (!data.patch_instances.is_empty()).then(|| gate::Gate::new(device)).transpose()?;
        Ok(Self { reset: reset::Reset::new(device, false)?, scan, gate })
    }
}

/// The listed patch instances, which passes over patches look at: those of all placed parts in sight, or of a list of
/// parts (`occlusion/parts.rs`).
#[derive(Clone, Copy)]
pub(crate) struct PatchList<'a> {
    /// Their [`PatchRun`](crate::abi::PatchRun)s.
    pub runs: &'a Buffer,
    /// One for each of them.
    pub threads: Threads<'a>,
}

/// The passes, and the counters of all stages.
pub(crate) struct Common {
    pub(super) passes: Arc<Passes>,
    /// Draws of sub-patches, list by list: plain, trimmed, and patches drawn by their corners, if they have a list.
    pub draws: Buffer,
    pub counters: Buffer,
    /// The counters as they were after the reusable results; they stay from frame to frame.
    pub counters_of_view: Buffer,
    pub sums: Buffer,
}

impl Common {
    /// `scanned`: elements of the longest prefix sum.
    pub(super) fn new(room: &Room<'_>, passes: &Arc<Passes>, scanned: u32) -> Result<Self, GpuError> {
        let lists = room.counts.patch_lists();
        Ok(Self {
            passes: Arc::clone(passes),
            draws: room.indirect::<vk::DrawIndirectCommand>("draws", lists * room.capacities.tessellation.draws)?,
            counters: room.indirect::<Counters>("counters", 1)?,
            counters_of_view: room.structs::<Counters>("counters of the view", 1)?,
            sums: room.words("scan sums", scan::block_count(scanned))?,
        })
    }

    /// Empties the draws and clears the counters.
    pub(super) fn reset(&self, frame: &Frame<'_>, cmd: &Commands<'_>) {
        let bindings = reset::Bindings { frame: frame.constants, draws: &self.draws, counters: &self.counters };
        self.passes.reset.record(cmd, &bindings, frame.counts.patch_lists() * frame.capacities.tessellation.draws);
        let w = Access::COMPUTE_WRITE;
        cmd.after(w, w);
    }

    /// After all lists: removes the draws of patches if a list overflowed.
    pub(super) fn gate(&self, cmd: &Commands<'_>) {
        let Some(gate) = &self.passes.gate else { return };
        let (counted, drawn) = (Access::COMPUTE_WRITE, Access::COMPUTE_WRITE | Access::INDIRECT_READ);
        barrier::buffers(cmd, &[(&self.counters, counted | Access::INDIRECT_READ, Access::COMPUTE_WRITE)]);
        gate.record(cmd, &self.counters);
        barrier::buffers(cmd, &[(&self.counters, counted, drawn)]);
    }

    /// Records one prefix sum; the total follows the last start.
    pub(super) fn scan(&self, cmd: &Commands<'_>, counts: &Buffer, starts: &Buffer, count: u32) {
        let (sums, w) = (&self.sums, Access::COMPUTE_WRITE);
        cmd.after(w, w);
        let bindings = scan::Bindings { values: counts, offsets: starts, sums, total: starts, total_index: count };
        self.passes.scan.record(cmd, scan::Count::Host(count), &bindings);
    }

    /// Records one prefix sum of an element of each of `lists` for each listed patch instance; the total follows the
    /// last start. There are at most `most` patch instances, and one element and two starts more.
    pub(super) fn scan_listed(
        &self,
        cmd: &Commands<'_>,
        (counts, starts): (&Buffer, &Buffer),
        threads: Threads<'_>,
        (lists, most): (u32, u32),
    ) {
        let dispatches = match threads {
            Threads::Host(patch_instances) => return self.scan(cmd, counts, starts, lists * patch_instances),
            Threads::Gpu(dispatches) => dispatches,
        };
        let (sums, w) = (&self.sums, Access::COMPUTE_WRITE);
        cmd.after(w, w);
        // the start of one more element is the total; the sum that includes that element is not used
        let count = scan::Count::Gpu {
            counts: dispatches,
            index: (offset_of!(ListDispatches, scanned) / size_of::<u32>()) as u32,
            arguments: dispatches,
            offset: offset_of!(ListDispatches, blocks) as u64,
            capacity: lists * most + 1,
        };
        let total_index = lists * most + 1;
        let bindings = scan::Bindings { values: counts, offsets: starts, sums, total: starts, total_index };
        self.passes.scan.record(cmd, count, &bindings);
    }
}
