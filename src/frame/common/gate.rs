//! Pass `gate`: if a list of this frame overflowed, sets the numbers of patch draws to 0.
//!
//! ```text
//!   trim table, sub-patches, draws, chords ──counters.failed──▶ numbers of draws: unchanged, or 0
//! ```
//!
//! Reads: `counters`. Writes: `counters`. Twin: `src/twin/gate.rs`.
//! Parity: exact.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders;

/// The pass.
pub(crate) struct Gate {
    kernel: Kernel,
}

impl Gate {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        Ok(Self { kernel: Kernel::new(device, "gate", &shaders::GATE_COMP, &[])? })
    }

    /// One thread.
    pub(crate) fn record(&self, cmd: &Commands<'_>, counters: &Buffer) {
        self.kernel.record(cmd, &[counters.into()], 1);
    }
}
