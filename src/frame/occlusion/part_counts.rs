//! Pass `part_counts`: which placed parts in sight are listed, and so have their patches looked at.
//!
//! ```text
//!   parts in sight      A   B   C   D        C was hidden
//!   patch instances     4   2   0   5
//!   begins a run        1   0   0   1        B follows A
//! ```
//!
//! Reads: `parts_in_sight`, `hidden_now`; `hidden_before`, for the second and third list. Writes: `counts`, `counters`;
//! `hidden_before`, for the first list. Twin: `src/twin/parts.rs`.
//! Parity: exact.

use crate::abi::PartList;
use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders;

/// The pass.
pub(crate) struct PartCounts {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    /// [`PartInSight`](crate::abi::PartInSight)s.
    pub parts_in_sight: &'a Buffer,
    /// Whether each group of faces of the placed parts was hidden in the previous frame that had it in sight.
    pub hidden_before: &'a Buffer,
    /// The same now: the last result of pass `cull_parts`.
    pub hidden_now: &'a Buffer,
    /// Two words a part in sight: all numbers of patch instances, then all beginnings of runs.
    pub counts: &'a Buffer,
    /// `hidden_parts`.
    pub counters: &'a Buffer,
}

impl PartCounts {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(device, "part counts", &shaders::PART_COUNTS_COMP, &[])? })
    }

    /// One thread for each part in sight.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, list: PartList) {
        let resources = [b.parts_in_sight, b.hidden_before, b.hidden_now, b.counts, b.counters].map(Into::into);
        self.kernel.bind(cmd, &resources, bytemuck::bytes_of(&list));
        self.kernel.dispatch(cmd, list.parts);
    }
}
