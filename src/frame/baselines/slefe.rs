//! Pass `baseline_slefe`: divides patches by slefes, in place of pass `bound`.
//!
//! ```text
//!    box of the patch ──▶ outside the picture, turned away? ──▶ tau = 0   as in pass `bound`
//!         │
//!         ▼
//!    slefe boxes of the net ──▶ largest extent e in pixels ──▶ tau = m sqrt(e / deviation), in both directions
//! ```
//!
//! Degrees above the table's, and boxes that reach the near plane, are counted as clamps. Weights are ignored, as in
//! the source.
//!
//! Reads: `frame`, `views`, `instances`, `face_instances`, `faces`, `patches`, `patch_instances`, `cones`, `points`,
//! `slefes`. Writes: `taus`, `counters`. The same in `f64`: `Way::Ipass` of `src/baselines/factors`.

use crate::bindings::Bounded;
use crate::frame::common::kernel::{Kernel, Threads};
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders;

/// The pass.
pub(crate) struct BaselineSlefe {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub bounded: Bounded<'a>,
    /// Segments, and bounds of the basis functions on them.
    pub slefes: &'a Buffer,
}

impl BaselineSlefe {
    /// `cones`: some closed part has no trims.
    pub(crate) fn new(device: &Device, cones: bool) -> Result<Self, GpuError> {
        let kernel = Kernel::new(device, "baseline slefe", &shaders::BASELINE_SLEFE_COMP, &Bounded::constants(cones))?;
        Ok(Self { kernel })
    }

    /// One thread for each listed patch instance.
    pub(crate) fn record<'t>(&self, cmd: &Commands<'_>, b: &Bindings<'_>, threads: impl Into<Threads<'t>>) {
        let resources = [b.bounded.resources().as_slice(), &[b.slefes.into()]].concat();
        self.kernel.record_threads(cmd, &resources, threads.into());
    }
}
