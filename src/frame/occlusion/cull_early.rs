//! Pass `cull_early`: patches that were hidden in the previous frame are not drawn, unless pass
//! [`cull_late`](super::cull_late) finds that they may be visible now.
//!
//! Reads: `frame`, `hidden`. Writes: `taus`, `counters`. Twin: `src/twin/occlusion.rs`.

use crate::frame::common::kernel::Kernel;
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders;

/// The pass.
pub(crate) struct CullEarly {
    kernel: Kernel,
}

/// Its buffers, in binding order.
pub(crate) struct Bindings<'a> {
    pub frame: &'a Buffer,
    /// Whether each patch instance was hidden.
    pub hidden: &'a Buffer,
    pub taus: &'a Buffer,
    /// `hidden`.
    pub counters: &'a Buffer,
    /// [`PatchRun`](crate::abi::PatchRun)s of the patch instances in sight.
    pub in_sight: &'a Buffer,
}

impl CullEarly {
    pub(crate) fn new(device: &Device) -> Result<Self, GpuError> {
        let kernel = Kernel::new(device, "cull early", &shaders::CULL_EARLY_COMP, &[])?;
        Ok(Self { kernel })
    }

    /// One thread for each of the `patch_instances` in sight.
    pub(crate) fn record(&self, cmd: &Commands<'_>, b: &Bindings<'_>, patch_instances: u32) {
        let resources = [b.frame, b.hidden, b.taus, b.counters, b.in_sight].map(Into::into);
        self.kernel.record(cmd, &resources, patch_instances);
    }
}
