//! Pass `part_runs`: the runs of the patch instances of listed parts, their number, and the dispatches over them.
//!
//! ```text
//!   counts ──scan──▶ starts ─▶ runs: first place, first patch instance of each     part_counts has the counts
//!                           ─▶ frame: listed_patch_instances, run_count
//!                           ─▶ dispatches
//! ```
//!
//! Reads: `parts_in_sight`, `counts`, `starts`. Writes: `frame`, `runs`, `dispatches`, `counters`.
//! Twin: `src/twin/parts.rs`.
//! Parity: exact.

use crate::abi::PartList;
use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders;

/// The pass.
pub(crate) struct PartRuns {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    /// The frame's constants, as a storage buffer.
    pub frame: &'a Buffer,
    /// [`PartInSight`](crate::abi::PartInSight)s.
    pub parts_in_sight: &'a Buffer,
    /// As pass `part_counts` writes them.
    pub counts: &'a Buffer,
    /// Their prefix sums, one more than there are counts.
    pub starts: &'a Buffer,
    /// [`PatchRun`](crate::abi::PatchRun)s of the patch instances of listed parts.
    pub runs: &'a Buffer,
    /// [`ListDispatches`](crate::abi::ListDispatches).
    pub dispatches: &'a Buffer,
    /// `listed_patches`.
    pub counters: &'a Buffer,
}

impl PartRuns {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(device, "part runs", &shaders::PART_RUNS_COMP, &[])? })
    }

    /// One thread for each part in sight; one if there is none.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, list: PartList) {
        let lists = [b.starts, b.runs, b.dispatches, b.counters];
        let resources: Vec<_> =
            [b.frame, b.parts_in_sight, b.counts].into_iter().chain(lists).map(Into::into).collect();
        self.kernel.bind(cmd, &resources, bytemuck::bytes_of(&list));
        self.kernel.dispatch(cmd, list.parts.max(1));
    }
}
