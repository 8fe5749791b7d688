//! Pass `cull_early`: patches that were hidden in the previous frame are not drawn, unless pass
//! [`cull_late`](super::cull_late) finds that they may be visible now.
//!
//! Reads: `frame`, `hidden`. Writes: `taus`, `counters`. Twin: `src/twin/occlusion.rs`.
//! Parity: exact.

use crate::frame::common::kernel::{Kernel, Threads};
use crate::gpu::{Buffer, Commands, Device, GpuError};
use crate::shaders::{self, constant};

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
    /// [`PatchRun`](crate::abi::PatchRun)s of the listed patch instances.
    pub runs: &'a Buffer,
}

impl CullEarly {
    /// `all`: all patches were hidden, whatever `hidden` says.
    pub(crate) fn new(device: &Device, all: bool) -> Result<Self, GpuError> {
        let name = if all { "cull early (all)" } else { "cull early" };
        let constants = [(constant::ALL_WERE_HIDDEN, u32::from(all))];
        let kernel = Kernel::new(device, name, &shaders::CULL_EARLY_COMP, &constants)?;
        Ok(Self { kernel })
    }

    /// One thread for each listed patch instance.
    pub(crate) fn record<'t>(&self, cmd: &Commands<'_>, b: &Bindings<'_>, threads: impl Into<Threads<'t>>) {
        let resources = [b.frame, b.hidden, b.taus, b.counters, b.runs].map(Into::into);
        self.kernel.record_threads(cmd, &resources, threads.into());
    }
}
