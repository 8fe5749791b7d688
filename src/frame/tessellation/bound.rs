//! Pass `bound`: finds the patches that may be visible, and bounds how finely each must be divided.
//!
//! ```text
//!    box of the patch ──▶ outside the picture? all of it turned away? ──▶ tau = 0
//!         │
//!         ▼ smallest W of its control points
//!    second derivatives x pixels per unit ──▶ (tau_u, tau_v), the guaranteed factor
//! ```
//!
//! The factor is derived in [`twin::factor`](crate::twin::factor).
//!
//! Reads: `frame`, `views`, `instances`, `face_instances`, `faces`, `patches`, `patch_instances`, `cones`, `points`.
//! Writes: `taus`, `counters`.
//! Twin: `src/twin/bound.rs`.
//! Parity: exact; on a GPU with other quotients and roots a factor may differ by one.

use crate::bindings::Bounded;
use crate::frame::common::kernel::{Kernel, Threads};
use crate::gpu::{Commands, Device, GpuError};
use crate::shaders;

/// The pass.
pub(crate) struct Bound {
    kernel: Kernel,
}

impl Bound {
    /// `cones`: some closed part has no trims.
    pub(crate) fn new(device: &Device, cones: bool) -> Result<Self, GpuError> {
        let kernel = Kernel::new(device, "bound", &shaders::BOUND_COMP, &Bounded::constants(cones))?;
        Ok(Self { kernel })
    }

    /// One thread for each listed patch instance.
    pub(crate) fn record<'t>(&self, cmd: &Commands<'_>, b: &Bounded<'_>, threads: impl Into<Threads<'t>>) {
        self.kernel.record_threads(cmd, &b.resources(), threads.into());
    }
}
